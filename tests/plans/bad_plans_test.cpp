#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/plans/bad_plans.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

/// Code and place of each problem.
std::vector<std::string> codes_and_places(const PlanOrProblems& result) {
  std::vector<std::string> out;
  if (result) return out;
  for (const core::Error& problem : result.error()) {
    out.push_back(fmt::format("{} {}", core::code_name(problem.code), problem.where));
  }
  return out;
}

// Codes and places are written by hand: who adds a plan knows which fault it has, and where. With
// RONDURE_REWRITE=1 writes the approved sentences; read every one of the diff as the technician
// who has to mend the plan.
TEST(BadPlans, EveryProblemHasItsCodeItsPlaceAndOneLineOfApprovedWords) {
  const auto plans = testing::bad_plans();
  EXPECT_EQ(plans.size(), 128U);
  std::string found;
  for (const testing::BadPlan& bad : plans) {
    SCOPED_TRACE(bad.file);
    const auto result = parse_plan(bad.text, testing::bad_plans_folder(), bad.file);
    EXPECT_FALSE(result.has_value());
    EXPECT_EQ(codes_and_places(result), bad.problems);
    const std::string lines = testing::lines_of(result);
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), std::ssize(bad.problems));
    found += fmt::format("{}# {}\n{}", found.empty() ? "" : "\n", bad.file, lines);
  }
  const auto approved = testing::source_dir() / "tests" / "plans" / "bad_plans_approved.txt";
  if (testing::rewriting()) {
    ASSERT_TRUE(record::write_file(approved, found));
  }
  EXPECT_EQ(found, testing::bytes_of(approved));
}

}  // namespace
}  // namespace rondure::plans
