#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using testing::bytes_of;
using testing::lines_of;

/// A line a problem: its code, and where it is.
std::string codes_and_places(const PlanOrProblems& result) {
  std::string out;
  if (result) return out;
  for (const core::Error& problem : result.error()) {
    out += fmt::format("{} {}\n", core::code_name(problem.code), problem.where);
  }
  return out;
}

// The .expected files are written by hand: who adds a plan knows which fault it has, and where.
TEST(BadPlans, EveryProblemHasItsCodeAndItsPlace) {
  const auto plans = testing::plans_in(testing::example("bad"));
  EXPECT_EQ(plans.size(), 94U);
  for (const auto& path : plans) {
    SCOPED_TRACE(path.filename().string());
    const PlanOrProblems result = read_plan(path);
    EXPECT_FALSE(result.has_value());
    auto expected = path;
    expected.replace_extension(".expected");
    EXPECT_EQ(codes_and_places(result), bytes_of(expected));
  }
}

// With RONDURE_REWRITE=1 writes the approved sentences; read every one of the diff as the
// technician who has to mend the plan.
TEST(BadPlans, EveryProblemIsReportedWordForWord) {
  std::string found;
  for (const auto& path : testing::plans_in(testing::example("bad"))) {
    found += fmt::format("{}# {}\n{}", found.empty() ? "" : "\n", path.filename().string(),
                         lines_of(read_plan(path)));
  }
  const auto approved = testing::source_dir() / "tests" / "plans" / "bad_plans_approved.txt";
  if (testing::rewriting()) {
    ASSERT_TRUE(record::write_file(approved, found));
  }
  EXPECT_EQ(found, bytes_of(approved));
}

TEST(BadPlans, AProblemIsOneLine) {
  for (const auto& path : testing::plans_in(testing::example("bad"))) {
    SCOPED_TRACE(path.filename().string());
    const PlanOrProblems result = read_plan(path);
    ASSERT_FALSE(result.has_value());
    for (const core::Error& problem : result.error()) {
      EXPECT_EQ(core::to_line(problem).find('\n'), std::string::npos);
      EXPECT_FALSE(problem.what.empty());
      EXPECT_NE(problem.code, core::Code::kInternal);
    }
  }
}

}  // namespace
}  // namespace rondure::plans
