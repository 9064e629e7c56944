#include <gtest/gtest.h>

#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using testing::bytes_of;
using testing::lines_of;

// With RONDURE_REWRITE=1 writes the .expected files; read every sentence of the diff as the
// technician who has to mend the plan.
TEST(BadPlans, EveryProblemIsReportedWordForWord) {
  const auto plans = testing::plans_in(testing::example("bad"));
  EXPECT_EQ(plans.size(), 84U);
  for (const auto& path : plans) {
    SCOPED_TRACE(path.filename().string());
    const PlanOrProblems result = read_plan(path);
    EXPECT_FALSE(result.has_value());
    auto expected = path;
    expected.replace_extension(".expected");
    if (testing::rewriting()) {
      ASSERT_TRUE(record::write_file(expected, lines_of(result)));
    }
    EXPECT_EQ(lines_of(result), bytes_of(expected));
  }
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
