// Damaged journals, archives, calibrations, lists of digests and signatures.

#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "fixture/calibration.h"
#include "plans/run/record.h"
#include "record/archive/archive.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/internal/schema.h"
#include "record/journal/journal.h"
#include "record/signature.h"
#include "tests/app/files.h"
#include "tests/doors/exact.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/row_damage.h"
#include "tests/fuzz/wrong_text.h"
#include "tests/record/sample_run.h"

namespace rondure::doors {
namespace {

namespace fs = std::filesystem;

/// Some bytes changed, and the end lost in one case of four.
std::string with_bytes_changed(std::string bytes, std::mt19937& random) {
  for (auto left = 1 + random() % 20; left > 0; --left) {
    bytes[random() % bytes.size()] = static_cast<char>(random());
  }
  if (random() % 4 == 0) bytes.resize(random() % bytes.size());
  return bytes;
}

/// Runs of every kind of contents, sealed, interrupted, and open with a log beside it.
const std::vector<fs::path>& good_runs() {
  static const std::vector<fs::path> runs = [] {
    std::vector<fs::path> out;
    for (unsigned seed = 0; seed < 4; ++seed) {
      record::RunRecord run = record::sample_run(seed, 12);
      run.sealed = seed % 4 != 3;
      out.push_back(fuzz::work_folder() / fmt::format("good-run-{}", seed));
      if (const auto written = record::write_run(out.back(), run); !written) {
        throw std::runtime_error(written.error().what);
      }
    }
    return out;
  }();
  return runs;
}

std::string wrong_with_run(const fs::path& directory) {
  const auto read = record::read_journal(directory);
  if (!read) return fuzz::wrong_with_refusal(read.error());
  for (const std::string& fault : record::faults_of(*read)) {
    const core::Error refusal = {core::Code::kJournal, fault, {}};
    if (auto wrong = fuzz::wrong_with_refusal(refusal); !wrong.empty()) return wrong;
  }
  if (const auto known = plans::check_record(*read); !known)
    return fuzz::wrong_with_refusal(known.error());
  return {};
}

/// A copy of a good run for one case.
fs::path copied_run(std::size_t index) {
  fs::path directory = fuzz::work_folder() / "damaged-run";
  fs::remove_all(directory);
  fs::copy(good_runs()[index % good_runs().size()], directory);
  return directory;
}

TEST(JsonDoor, RefusesWhatIsNestedDeeperThanAnyDocument) {
  for (const std::size_t levels : {64U, 65U, 1'000'000U}) {
    for (const auto& [open, close] : {std::pair("[", "]"), std::pair("{\"a\":", "}")}) {
      SCOPED_TRACE(fmt::format("{} {}", levels, open));
      std::string text;
      for (std::size_t i = 0; i < levels; ++i) text += open;
      text += "\"]}\\\"[{\"";  // brackets in a text are none
      text += std::string(levels, *close);
      const auto read = core::read_json<nlohmann::json>(text, "deep.json");
      ASSERT_EQ(read.has_value(), levels == 64);
      EXPECT_EQ(read ? "" : fuzz::wrong_with_refusal(read.error()), "");
      for (const std::size_t cut : {text.size() / 2, text.size() - 1}) {
        EXPECT_FALSE(core::read_json<nlohmann::json>(text.substr(0, cut), "cut.json"));
      }
      const auto calibration = fixture::parse_calibration(text, "deep.json");
      ASSERT_FALSE(calibration);
      EXPECT_EQ(fuzz::wrong_with_refusal(calibration.error()), "");
    }
  }
}

TEST(FilesDoor, LeadsNowhereThroughALink) {
  const fs::path run = copied_run(0);
  const fs::path elsewhere = fuzz::work_folder() / "elsewhere";
  fs::remove_all(elsewhere);
  fs::create_directory(elsewhere);
  app::testing::write(elsewhere / "a.csv", "mine");
  fs::create_directory_symlink(elsewhere, run / "corrections");
  for (const char* name : {"corrections/a.csv", "corrections/../corrections/a.csv", "../a.csv"}) {
    EXPECT_FALSE(record::read_inside(run, name)) << name;
    EXPECT_FALSE(record::write_inside(run, name, "x")) << name;
    EXPECT_FALSE(record::remove_inside(run, name)) << name;
  }
  record::remove_temporaries(run, "corrections");
  EXPECT_EQ(app::testing::read(elsewhere / "a.csv"), "mine");
  EXPECT_EQ(app::testing::names_in(elsewhere), std::vector<std::string>{"a.csv"});
}

TEST(JournalDoor, StandsDamagedRowsThatWereSealedAgain) {
  std::vector<std::string> tables;
  for (const record::Table& table : record::chained_tables()) tables.emplace_back(table.name);
  fuzz::try_cases({3000}, [&](unsigned seed) {
    std::mt19937 random(seed);
    const fs::path run = copied_run(random() % 3);
    fuzz::damage_rows(run / record::kJournalName, tables, random);
    fuzz::reseal(run);
    return wrong_with_run(run);
  });
}

TEST(JournalDoor, StandsDamagedBytes) {
  fuzz::try_cases({2000}, [](unsigned seed) {
    std::mt19937 random(seed);
    const fs::path run = copied_run(random() % 4);
    const auto names = app::testing::names_in(run);
    const fs::path file = run / names[random() % names.size()];
    app::testing::write(file, with_bytes_changed(app::testing::read(file), random));
    return wrong_with_run(run);
  });
}

TEST(JournalDoor, StandsJournalsThatEndTooEarly) {
  const std::string bytes = app::testing::read(good_runs().front() / record::kJournalName);
  const fs::path run = copied_run(0);
  for (const std::size_t size : cuts_of(bytes.size(), 80)) {
    app::testing::write(run / record::kJournalName, bytes.substr(0, size));
    ASSERT_EQ(wrong_with_run(run), "") << size;
  }
}

const fs::path& good_archive() {
  static const fs::path file = [] {
    const fs::path out = fuzz::work_folder() / "good-archive.db";
    auto archive = record::Archive::open(record::parse_archive_place(out.string()).value(),
                                         record::Archive::Access::kWrite);
    for (int number = 0; archive && number < 12; ++number) {
      record::ArchiveRun run;
      run.head.journal_sha256 = std::string(60, 'a') + std::to_string(1000 + number);
      run.head.run_id = fmt::format("run {}", number);
      run.head.started_utc = fmt::format("2026-11-21T02:33:{}Z", 10 + number);
      run.head.part_id = "SP-50-80";
      run.results.resize(2);
      run.results[0].feature = "running surface";
      run.results[0].value = 0.005;
      run.results[0].upper_limit = 0.012;
      if (!archive->push(run)) break;
    }
    return out;
  }();
  return file;
}

std::string wrong_with_archive(const fs::path& file) {
  auto archive = record::Archive::open(record::parse_archive_place(file.string()).value(),
                                       record::Archive::Access::kRead);
  if (!archive) return fuzz::wrong_with_refusal(archive.error());
  record::ArchiveFilter filter;
  auto page = archive->newest(filter, 5);
  if (!page) return fuzz::wrong_with_refusal(page.error());
  if (!page->empty()) {
    const record::ArchivedResult last = page->back();
    if (const auto more = archive->newest(filter, 50, &last); !more) {
      return fuzz::wrong_with_refusal(more.error());
    }
  }
  return {};
}

TEST(ArchiveDoor, StandsDamage) {
  const std::string good = app::testing::read(good_archive());
  ASSERT_GT(good.size(), 10'000U);
  const fs::path file = fuzz::work_folder() / "damaged-archive.db";
  fuzz::try_cases({5000}, [&](unsigned seed) {
    std::mt19937 random(seed);
    for (const char* beside : {"-wal", "-shm", "-journal"}) fs::remove(file.string() + beside);
    const bool by_rows = random() % 3 != 0;
    app::testing::write(file, by_rows ? good : with_bytes_changed(good, random));
    if (by_rows) {
      fuzz::damage_rows(file, {"rondure_run", "rondure_result", "rondure_result"}, random);
    }
    return wrong_with_archive(file);
  });
}

TEST(ArchiveDoor, StandsArchivesThatEndTooEarly) {
  const std::string good = app::testing::read(good_archive());
  const fs::path file = fuzz::work_folder() / "short-archive.db";
  for (const std::size_t size : cuts_of(good.size(), 40)) {
    app::testing::write(file, good.substr(0, size));
    ASSERT_EQ(wrong_with_archive(file), "") << size;
  }
}

TEST(CalibrationDoor, StandsFilesThatEndTooEarly) {
  const std::string good =
      app::testing::read(app::testing::example("03_calibration/fixture-calibration.json"));
  for (const std::size_t size : cuts_of(good.size(), 300)) {
    const Exact exact(std::string_view(good).substr(0, size));
    const auto read = fixture::parse_calibration(exact.view(), "calibration.json");
    ASSERT_FALSE(read) << size;
    ASSERT_EQ(fuzz::wrong_with_refusal(read.error()), "") << size;
  }
}

TEST(DigestsDoor, StandsListsThatEndTooEarly) {
  const std::string good = app::testing::read(good_runs().front() / record::kChecksumsName);
  const fs::path run = copied_run(0);
  for (std::size_t size = 0; size < good.size(); ++size) {
    app::testing::write(run / record::kChecksumsName, good.substr(0, size));
    const auto read = record::read_checksums(run);
    ASSERT_EQ(read ? "" : fuzz::wrong_with_refusal(read.error()), "") << size;
  }
}

TEST(SignatureDoor, StandsKeysAndSignaturesThatEndTooEarly) {
  // RFC 8032, 7.1, TEST 1.
  const std::string key =
      "-----BEGIN PUBLIC KEY-----\nMCowBQYDK2VwAyEA11qYAYKxCrfVS/7TyWQHOg7hcvPapiMlrwIaaPcHURo=\n"
      "-----END PUBLIC KEY-----\n";
  for (std::size_t size = 0; size < key.size(); size += 3) {
    const auto holds = record::signature_holds("", std::string(64, 'x'), key.substr(0, size));
    ASSERT_EQ(holds ? "" : fuzz::wrong_with_refusal(holds.error()), "") << size;
  }
  for (std::size_t size = 0; size <= 70; ++size) {
    const Exact signature(std::string(size, 'x'));
    const auto holds = record::signature_holds("sums", signature.view(), key);
    ASSERT_TRUE(holds) << holds.error().what;
    EXPECT_FALSE(*holds) << size;
  }
}

}  // namespace
}  // namespace rondure::doors
