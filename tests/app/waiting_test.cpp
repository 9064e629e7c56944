// What the terminal shows while an evaluation takes long, and how Ctrl-C ends it.

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/on_terminal.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Waiting, SaysWhichTrialItIsAtAndCtrlCEndsItAtOnce) {
  const Scratch folder;
  const std::string plan = (folder / "plan.json").string();
  auto long_evaluation = example_plan("09_axle_points_file");
  long_evaluation["uncertainty"]["most_trials"] = 1'000'000;
  long_evaluation["uncertainty"]["tolerance_um"] = 0;
  write(plan, long_evaluation.dump());
  const std::string run = (folder / "run").string();
  OnTerminal program({"run", plan, "--out", run, "--archive", "none"});
  ASSERT_TRUE(program.wait_for("evaluating 1 of 1: section 3, trial ")) << program.shown();
  ASSERT_TRUE(program.wait_for(", about ")) << program.shown();
  EXPECT_THAT(program.shown(), HasSubstr(" of 1000000"));
  const auto asked = std::chrono::steady_clock::now();
  program.type("\x03");
  EXPECT_EQ(program.finish(), -1);
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::milliseconds(500));
  EXPECT_THAT(program.shown(), HasSubstr("every touch is kept; to finish the run: rondure run '" +
                                         plan + "' --out '" + run + "' --resume"));
  EXPECT_EQ(journal_of(run).ending, "finished");
}

TEST(Waiting, SaysNothingOfWhatIsQuickOrQuiet) {
  const Scratch folder;
  OnTerminal quick({"run", example("09_axle_points_file.json"), "--out",
                    (folder / "quick").string(), "--archive", "none"});
  EXPECT_EQ(quick.finish(), 0);
  EXPECT_THAT(quick.shown(), Not(HasSubstr("evaluating")));
}

}  // namespace
}  // namespace rondure::app::testing
