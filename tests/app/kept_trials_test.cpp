// The draws that a run keeps: reports and comparisons take them, and draw again, with a word, where
// they are not those of this run and this program. No number changes.

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/checksums.h"
#include "record/sha256.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class KeptTrials : public ::testing::Test {
 protected:
  void SetUp() override { fs::copy(example_runs() / "01_spool_simulated", run_); }

  /// Writes the report again and expects the same one.
  [[nodiscard]] std::string told_by_report() const {
    const std::string before = read(run_ / "report.json");
    const Outcome outcome = rondure({"report", run_, "--format", "json"});
    EXPECT_LE(outcome.status, 1) << outcome.err;
    EXPECT_EQ(read(run_ / "report.json"), before);
    return outcome.err;
  }
  [[nodiscard]] std::string trials() const { return read(run_ / "trials.bin"); }
  /// Gives trials.bin these bytes and a line that agrees with them.
  void forge(const std::string& bytes) const {
    write(run_ / "trials.bin", bytes);
    ASSERT_TRUE(record::update_checksums(run_, {{"trials.bin", record::sha256_hex(bytes)}}));
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_ / "run";
};

TEST_F(KeptTrials, AreTakenByReportAndCompareAndChangedByNeither) {
  const std::string before = trials();
  ASSERT_FALSE(before.empty());
  EXPECT_EQ(told_by_report(), "");
  EXPECT_EQ(rondure({"compare", run_}).err, "");
  EXPECT_EQ(trials(), before);
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
}

// The verdict would be another with these draws: a report that took them would say so.
TEST_F(KeptTrials, AreTakenWithoutDrawingAgain) {
  std::string bytes = trials();
  const std::size_t body = bytes.find('\n', bytes.find("journal ")) + 1;
  // behind the number of chains and that of the trials of the first one
  double first = 0.0;
  std::memcpy(&first, bytes.data() + body + 16, sizeof first);
  ASSERT_GT(first, 1e-6);
  ASSERT_LT(first, 1.0) << "a form value in mm";
  first = 1.0;
  std::memcpy(bytes.data() + body + 16, &first, sizeof first);
  forge(bytes);
  const std::string before = read(run_ / "report.json");
  EXPECT_LE(rondure({"report", run_, "--format", "json"}).status, 1);
  EXPECT_NE(read(run_ / "report.json"), before);
  const Outcome verified = rondure({"verify", run_});
  EXPECT_EQ(verified.status, 1) << "verify draws for itself";
}

TEST_F(KeptTrials, OfAnotherRunOrProgramOrWithOneChangedBitAreDrawnAgain) {
  const std::string good = trials();
  std::string bytes = good;
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  write(run_ / "trials.bin", bytes);
  EXPECT_THAT(told_by_report(), AllOf(HasSubstr("trials.bin: it was changed after it was written"),
                                      HasSubstr("the intervals are computed again")));
  EXPECT_EQ(trials(), good) << "they are kept again";
  EXPECT_EQ(told_by_report(), "");

  bytes = good;
  bytes.replace(bytes.find("program ") + 8, 4, "0000");
  forge(bytes);
  constexpr const char* kForeign = "another build, another processor or another run wrote it";
  EXPECT_THAT(told_by_report(), HasSubstr(kForeign));
  EXPECT_EQ(trials(), good);
  forge(read(example_runs() / "09_axle_points_file" / "trials.bin"));
  EXPECT_THAT(told_by_report(), HasSubstr(kForeign));
  EXPECT_EQ(trials(), good);

  fs::remove(run_ / "trials.bin");
  EXPECT_THAT(told_by_report(), HasSubstr("the intervals are computed again"));
  EXPECT_EQ(trials(), good);
}

TEST_F(KeptTrials, OfASignedRunChangeNothingThatIsSigned) {
  const std::string key = (folder_ / "key.pem").string();
  ASSERT_EQ(std::system(("openssl genpkey -algorithm ed25519 -out '" + key + "'").c_str()), 0);
  ASSERT_EQ(rondure({"sign", run_, "--key", key}).status, 0);
  fs::remove(run_ / "trials.bin");
  const std::string list = read(run_ / "SHA256SUMS");
  EXPECT_THAT(told_by_report(), HasSubstr("the intervals are computed again"));
  EXPECT_EQ(read(run_ / "SHA256SUMS"), list);
  EXPECT_THAT(names_in(run_), Not(Contains("trials.bin")));
}

TEST(RunWithoutIntervals, KeepsNoTrials) {
  const TemporaryFolder folder;
  ASSERT_LE(run_without_intervals("09_axle_points_file", {"--out", folder / "run"}).status, 1);
  EXPECT_THAT(names_in(folder / "run"), Not(Contains("trials.bin")));
}

}  // namespace
}  // namespace rondure::app::testing
