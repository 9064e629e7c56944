#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Arguments, HelpOfEveryVerbShowsAnExample) {
  for (const char* verb : {"validate", "plan", "run", "fit", "report", "verify"}) {
    SCOPED_TRACE(verb);
    const Outcome outcome = rondure({verb, "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr(std::string("Example: rondure ") + verb));
    EXPECT_THAT(outcome.err, IsEmpty());
  }
}

TEST(Arguments, HelpNamesEveryVerbAndTheExitStatus) {
  const Outcome outcome = rondure({"--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"validate", "plan", "run", "fit", "report", "verify", "Exit status"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST(Arguments, WhatIsNotUnderstoodIsNamed) {
  const std::string plan = example("01_spool_simulated.json").string();
  struct Case {
    std::vector<std::string> arguments;
    std::string named;
  };
  const std::vector<Case> cases = {
      {{}, "a verb is missing"},
      {{"measure"}, "there is no verb measure"},
      {{"--colour"}, "a verb is missing"},
      {{"run"}, "PLAN is required"},
      {{"run", plan, "--colour"}, "--colour"},
      {{"run", plan, "again"}, "again"},
      {{"run", plan, "--format", "docx"}, "docx"},
      {{"run", plan, "--seed", "-1"}, "0 to 9007199254740991"},
      {{"run", plan, "--seed", "1.5"}, "0 to 9007199254740991"},
      {{"run", plan, "--seed", "9007199254740992"}, "0 to 9007199254740991"},
      {{"fit", "cone", "points.csv"}, "cone"},
      {{"fit", "circle"}, "FILE is required"},
      {{"fit", "circle", "points.csv", "--reference", "mx"}, "mx"},
      {{"fit", "line", "points.csv", "--reference", "mc"}, "a line has ls and mz"},
      {{"verify"}, "RUN_DIR is required"},
      {{"report", "run", "--format", "html,doc"}, "doc"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(::testing::PrintToString(c.arguments));
    const Outcome outcome = rondure(c.arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(c.named));
    EXPECT_THAT(outcome.err, HasSubstr("--help"));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Arguments, ThePlanMayFollowTheFormats) {
  const TemporaryFolder folder;
  const Outcome outcome = rondure({"run", "--out", folder / "run", "--format", "html,csv",
                                   example("09_axle_points_file.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(names_in(folder / "run"),
              ::testing::ElementsAre("SHA256SUMS", "journal.db", "report.html", "results.csv",
                                     "touches.csv"));
}

TEST(Arguments, WhatIsNoPlanIsRefusedInOneSentence) {
  const TemporaryFolder folder;
  write(folder / "empty.json", "");
  for (const std::string& plan :
       {(folder / "empty.json").string(), folder.path().string(), (folder / "absent.json").string(),
        std::string("/dev/zero"), std::string()}) {
    SCOPED_TRACE(plan);
    const Outcome outcome = rondure({"run", plan, "--out", folder / "run"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  }
}

}  // namespace
}  // namespace rondure::app::testing
