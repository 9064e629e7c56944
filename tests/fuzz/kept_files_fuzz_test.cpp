// What is kept of earlier runs as files of text: calibrations, lists of digests.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "core/encodings.h"
#include "fixture/calibration.h"
#include "record/checksums.h"
#include "tests/app/files.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/wrong_text.h"
#include "tests/record/sample_run.h"

namespace rondure::fuzz {
namespace {

namespace fs = std::filesystem;

TEST(KeptFuzz, NoDamagedCalibrationUpsetsTheFixture) {
  const Mutation mutation(
      {app::testing::read(app::testing::example("03_calibration/fixture-calibration.json"))},
      json_words());
  try_cases({600, 100'000}, [&](unsigned seed) -> std::string {
    const auto parsed = fixture::parse_calibration(mutation.input(seed), "calibration.json");
    if (!parsed) return wrong_with_text(core::printable(core::to_line(parsed.error())));
    const auto again = fixture::parse_calibration(fixture::calibration_text(*parsed), "again");
    if (!again) return "its own text is not read back: " + again.error().what;
    const fixture::Kinematics kinematics = fixture::compensated({}, *parsed);
    for (const double angle : {-1.0, 0.0, 0.3}) {
      const Eigen::Isometry3d pose = fixture::body_to_machine(kinematics, {angle, -angle});
      if (!pose.matrix().allFinite()) return "a pose that is not finite";
    }
    return {};
  });
}

TEST(KeptFuzz, NoDamagedListOfDigestsUpsetsItsReader) {
  const record::Scratch scratch;
  ASSERT_TRUE(record::write_run(scratch / "run", record::sample_run(3, 5)));
  const Mutation mutation({app::testing::read(scratch / "run" / record::kChecksumsName)},
                          {"  ", " *", "\n", "\\", "../", "/etc/passwd", "\r", "\xff", "journal.db",
                           std::string(64, '0'), std::string(1, '\0')});
  const fs::path folder = work_folder() / "digests";
  fs::create_directory(folder);
  try_cases({600, 100'000}, [&](unsigned seed) -> std::string {
    app::testing::write(folder / record::kChecksumsName, mutation.input(seed));
    const auto read = record::read_checksums(folder);
    if (!read) return wrong_with_text(core::printable(core::to_line(read.error())));
    for (const record::Checksum& line : *read) {
      const fs::path file(line.file);
      const bool climbs = std::find(file.begin(), file.end(), "..") != file.end();
      if (file.is_absolute() || climbs || line.sha256.size() != 64) {
        return "a place outside: " + line.file;
      }
    }
    return {};
  });
}

}  // namespace
}  // namespace rondure::fuzz
