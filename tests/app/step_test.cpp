// A first run in single steps, driven through a terminal of its own.

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/on_terminal.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<std::string> stepwise(const Scratch& folder) {
  return {"run",    example("13_pose_search_virtual.json"),
          "--out",  (folder / "run").string(),
          "--step", "--archive",
          "none"};
}

TEST(Step, AsksBeforeEachMotionAndStopsInOrderOnQ) {
  const Scratch folder;
  OnTerminal program(stepwise(folder));
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
  EXPECT_THAT(program.shown(), HasSubstr("home machine and fixture"));
  int asked = 1;
  // Home, across, down to the pole, touch; around the sphere and so on.
  while (program.shown().find("point 2: touch") == std::string::npos && asked < 40) {
    program.type("\n");
    ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
    ++asked;
  }
  EXPECT_THAT(program.shown(),
              AllOf(HasSubstr("reference sphere, point 1: move from (0.000, 0.000, 500.000) to "
                              "(300.000, 0.000, 500.000) mm, 300.000 mm"),
                    HasSubstr("reference sphere, point 1: touch from ")));
  program.type("q\n");
  EXPECT_EQ(program.finish(), 3);
  EXPECT_THAT(program.shown(), AllOf(HasSubstr("stopped by the operator before: reference sphere, "
                                               "point 2: touch"),
                                     HasSubstr("--resume")));
  const auto record = journal_of(folder / "run");
  EXPECT_EQ(record.ending, "stopped");
  EXPECT_EQ(record.touches.size(), 1U);
  ASSERT_FALSE(record.decisions.empty());
  EXPECT_EQ(record.decisions.front().message,
            (core::Message{core::MessageCode::kSingleSteps, {10.0}}));
}

TEST(Step, GoesOnWithoutAskingAfterCAndMeasuresTheSame) {
  const Scratch folder;
  OnTerminal program(stepwise(folder));
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
  program.type("x\n");
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << "an unknown answer is asked again";
  program.type("c\n");
  EXPECT_LE(program.finish(), 1) << program.shown();
  const Scratch plain;
  const Outcome quickly = rondure({"run", example("13_pose_search_virtual.json"), "--out",
                                   (plain / "run").string(), "--archive", "none"});
  EXPECT_LE(quickly.status, 1) << quickly.err;
  const auto slow = journal_of(folder / "run");
  const auto quick = journal_of(plain / "run");
  ASSERT_EQ(slow.touches.size(), quick.touches.size());
  for (std::size_t i = 0; i < slow.touches.size(); ++i) {
    ASSERT_EQ(slow.touches[i].tip_mm, quick.touches[i].tip_mm);
  }
  EXPECT_GT(slow.touches.back().time_s, 3.0 * quick.touches.back().time_s) << "slower";
}

TEST(Step, RefusesWithoutATerminal) {
  const Scratch folder;
  Surroundings surroundings;
  const Outcome refused = rondure(stepwise(folder), surroundings);
  if (::isatty(STDIN_FILENO) == 1) GTEST_SKIP() << "the tests themselves have a terminal";
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("standard input is no terminal"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

}  // namespace
}  // namespace rondure::app::testing
