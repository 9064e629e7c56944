#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Outcome run_spool_into(const fs::path& place, const Surroundings& surroundings = {}) {
  return run_without_intervals("01_spool_simulated", {"--out", place}, surroundings);
}

TEST(OutputPlace, AFolderThatIsNotEmptyIsLeftAlone) {
  const Scratch folder;
  write(folder / "mine.txt", "keep this");
  const Outcome outcome = run_spool_into(folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("is not empty (it holds mine.txt)"),
                                 HasSubstr("name a new directory")));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("mine.txt"));
  EXPECT_EQ(read(folder / "mine.txt"), "keep this");
}

TEST(OutputPlace, ASecondRunIntoTheSameFolderIsRefused) {
  const Scratch folder;
  ASSERT_EQ(run_spool_into(folder / "run").status, 0);
  const std::string journal = read(folder / "run" / "journal.db");
  const Outcome again = run_spool_into(folder / "run");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, AllOf(HasSubstr("is finished; name another directory by --out"),
                               Not(HasSubstr("--resume"))));
  EXPECT_EQ(read(folder / "run" / "journal.db"), journal);
}

TEST(OutputPlace, AnImpossiblePlaceIsNamed) {
  const Scratch folder;
  write(folder / "file", "");
  for (const fs::path& place : {fs::path("/dev/null/run"), folder / "file", folder / "file" / "run",
                                fs::path("/proc/run"), folder / std::string(300, 'x')}) {
    SCOPED_TRACE(place);
    const Outcome outcome = run_spool_into(place);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(place.string()), HasSubstr("[file]")));
  }
  EXPECT_THAT(names_in(folder.path()), ElementsAre("file"));
}

TEST(OutputPlace, MayHaveBlanksQuotesAndOtherScripts) {
  const Scratch folder;
  const fs::path place = folder / "a b" / "it's \xe6\x97\xa5\xe6\x9c\xac & <i>";
  EXPECT_EQ(run_spool_into(place).status, 0);
  EXPECT_EQ(rondure({"verify", place}).status, 0);
}

TEST(OutputPlace, NamesTheRunAlsoWithATrailingSlash) {
  const Scratch folder;
  ASSERT_EQ(run_spool_into((folder / "seven").string() + "/").status, 0);
  EXPECT_EQ(journal_of(folder / "seven").header.run_id, "seven");
}

TEST(OutputPlace, OfAPlanWithAnEndlessNameIsRefusedByItsOwnName) {
  const Scratch folder;
  const std::string name = std::string(240, 'p') + ".json";
  write_plan(folder / name, {});
  const Outcome outcome = rondure({"run", folder / name});  // the default folder is named after it
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("the run directory"), HasSubstr("cannot be made")));
}

TEST(OutputPlace, NeedsNoEnvironment) {
  const Scratch folder;
  Surroundings bare;
  bare.empty_environment = true;
  EXPECT_EQ(run_spool_into(folder / "run", bare).status, 0);
}

void expect_whole_or_absent(const fs::path& file, std::string_view ending) {
  if (!fs::exists(file)) return;
  const std::string bytes = read(file);
  ASSERT_GE(bytes.size(), ending.size());
  EXPECT_EQ(bytes.substr(bytes.size() - ending.size()), ending) << file;
}

TEST(FullDisk, StopsWithASentenceAndKeepsWhatWasWritten) {
  bool journal_kept = false;
  bool journal_sealed = false;
  for (const std::size_t bytes : {0U, 1'000U, 20'000U, 50'000U, 90'000U, 120'000U, 150'000U,
                                  200'000U, 300'000U, 400'000U, 600'000U, 900'000U}) {
    SCOPED_TRACE(bytes);
    const Scratch folder;
    Surroundings full;
    full.largest_file_bytes = bytes;
    // Ten touches of every point: more log than report, so that both run out of space.
    write_plan(folder / "plan.json", {{"/features/0/pose_search/repeats", 10}});
    const Outcome outcome = rondure({"run", folder / "plan.json", "--out", folder / "run"}, full);
    const auto left = names_in(folder / "run");
    expect_whole_or_absent(folder / "run" / "report.html", "</html>\n");
    expect_whole_or_absent(folder / "run" / "report.json", "}\n");
    for (const std::string& name : left) EXPECT_THAT(name, ::testing::Not(HasSubstr("tmp")));
    if (outcome.status == 0) continue;
    EXPECT_TRUE(outcome.status == 2 || outcome.status == 3)
        << outcome.status << " signal " << outcome.signal;
    // Standard error is a file of the same disk: nothing can be said there when not a byte fits.
    if (bytes > 0) {
      EXPECT_THAT(outcome.err, AllOf(HasSubstr("rondure: "), HasSubstr("raise the limit")));
    }
    if (outcome.status == 2) {
      EXPECT_THAT(left, IsEmpty());
      continue;
    }
    journal_kept = true;
    const auto journal = journal_of(folder / "run");
    journal_sealed = journal_sealed || journal.sealed;
    EXPECT_LE(rondure({"verify", folder / "run"}).status, 1);
  }
  EXPECT_TRUE(journal_kept);
}

TEST(FullDisk, LeavesAnOlderReportAsItWas) {
  const Scratch folder;
  ASSERT_EQ(run_spool_into(folder / "run").status, 0);
  const auto names = names_in(folder / "run");
  const std::string html = read(folder / "run" / "report.html");
  Surroundings full;
  full.largest_file_bytes = html.size() - 1;
  // The journal is larger than that: its private copy elsewhere is what cannot be made.
  const Outcome outcome = rondure({"report", folder / "run"}, full);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("free space"));
  EXPECT_EQ(names_in(folder / "run"), names);
  EXPECT_EQ(read(folder / "run" / "report.html"), html);
}

TEST(StandardOutput, ThatTakesNothingIsNotSilent) {
  const Scratch folder;
  const fs::path points = source_dir() / "tests/data/axle_mzc_3/points.csv";
  auto plan = example_plan("09_axle_points_file");
  leave_out_intervals(plan);
  write(folder / "plan.json", plan.dump());
  const std::vector<std::vector<std::string>> commands = {
      {"run", folder / "plan.json", "--out", folder / "run"},
      {"verify", folder / "run"},
      {"report", folder / "run", "--format", "html,json,csv"},
      {"validate", folder / "plan.json"},
      {"fit", "circle", points, "--json"},
      {"--help"},
      {"--version"}};
  for (const char* place : {"/dev/full", "closed"}) {
    for (const auto& command : commands) {
      SCOPED_TRACE(place + (" " + command.front()));
      Surroundings surroundings;
      surroundings.standard_output = place;
      const Outcome outcome = rondure(command, surroundings);
      EXPECT_EQ(outcome.status, 2);
      EXPECT_THAT(outcome.err, HasSubstr("cannot write to standard output"));
    }
    EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0) << "the run itself is whole";
    fs::remove_all(folder / "run");
  }
}

TEST(StandardOutput, ClosedIsNoErrorWhenNothingIsPrinted) {
  const Scratch folder;
  Surroundings closed;
  closed.standard_output = "closed";
  const Outcome outcome =
      run_without_intervals("09_axle_points_file", {"--out", folder / "run", "--quiet"}, closed);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
}

}  // namespace
}  // namespace rondure::app::testing
