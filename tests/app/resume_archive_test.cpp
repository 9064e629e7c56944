// A run that died on its way to the archive gets there by --resume.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t result_count(const fs::path& archive) { return history_of(archive)["results"].size(); }

TEST(ResumeArchive, DeliversARunThatDiedBehindItsReportsAndOnce) {
  const Scratch folder;
  const fs::path run = folder / "run";
  // As it is left by a death between the last report and the push.
  ASSERT_EQ(run_without_intervals("01_spool_simulated", {"--out", run, "--archive", "none"}).status,
            0);
  const auto names = names_in(run);
  const std::string sums = read(run / "SHA256SUMS");
  const Outcome resumed = rondure({"run", run, "--resume"});
  EXPECT_EQ(resumed.status, 0);
  EXPECT_THAT(resumed.err, HasSubstr("only its results had still to go to"));
  const std::size_t results = result_count(folder / "archive.db");
  EXPECT_GT(results, 0U);
  EXPECT_EQ(names_in(run), names);
  EXPECT_EQ(read(run / "SHA256SUMS"), sums);
  const Outcome again = rondure({"run", run, "--resume"});
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.err, HasSubstr("nothing to resume"));
  EXPECT_EQ(result_count(folder / "archive.db"), results);
}

TEST(ResumeArchive, ThatIsAwayLetsTheRunWait) {
  const Scratch folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(run_without_intervals("01_spool_simulated", {"--out", run, "--archive", "none"}).status,
            0);
  const fs::path away = folder / "away" / "archive.db";
  const Outcome resumed = rondure({"run", run, "--resume", "--archive", away});
  EXPECT_EQ(resumed.status, 0);
  EXPECT_THAT(resumed.err, AllOf(HasSubstr("no such file or folder"), HasSubstr("1 run waits")));
  fs::create_directory(folder / "away");
  EXPECT_EQ(rondure({"run", run, "--resume", "--archive", away}).status, 0);
  EXPECT_THAT(rondure({"run", run, "--resume", "--archive", away}).err,
              HasSubstr("nothing to resume"));
  EXPECT_GT(result_count(away), 0U);
}

/// A plan of its own folder that archives beside itself, and a run of it that lost its machine.
struct Beside {
  Scratch folder;
  Outcome lost;

  Beside() {
    write_plan(folder / "plan.json", {{"/simulation/faults", {{"connection_lost_at_touch", 60}}},
                                      {"/reports/archive", "mine.db"}});
    fs::create_directory(folder / "runs");
    lost = rondure({"run", folder / "plan.json", "--out", folder / "runs" / "1"});
  }
};

TEST(ResumeArchive, BesideThePlanIsFoundOnlyWithThePlan) {
  const Beside beside;
  const fs::path run = beside.folder / "runs" / "1";
  const fs::path plan = beside.folder / "plan.json";
  EXPECT_THAT(beside.lost.err, HasSubstr("rondure run '" + plan.string() + "' --out '" +
                                         run.string() + "' --resume"));
  const Outcome blind = rondure({"run", run, "--resume"});
  EXPECT_EQ(blind.status, 2);
  EXPECT_THAT(blind.err, AllOf(HasSubstr("mine.db stands beside the plan"), HasSubstr("--out")));
  EXPECT_EQ(journal_of(run).touches.size(), 59U) << "nothing was touched";
  EXPECT_EQ(rondure({"run", plan, "--out", run, "--resume"}).status, 0);
  EXPECT_THAT(names_in(beside.folder.path()), Contains("mine.db"));
  EXPECT_THAT(names_in(beside.folder / "runs"), Not(Contains("archive.db")));
}

TEST(ResumeArchive, StandsInTheCommandThatGoesOnWithoutItsPassword) {
  const Scratch folder;
  write_plan(folder / "plan.json", {{"/simulation/faults", {{"connection_lost_at_touch", 60}}}});
  const Outcome lost = rondure({"run", folder / "plan.json", "--out", folder / "run", "--archive",
                                "postgresql://me:secret@127.0.0.1:1/results"});
  EXPECT_EQ(lost.status, 3);
  EXPECT_THAT(lost.err, AllOf(HasSubstr("--resume --archive postgresql://me@127.0.0.1:1/results"),
                              Not(HasSubstr("secret"))));
}

}  // namespace
}  // namespace rondure::app::testing
