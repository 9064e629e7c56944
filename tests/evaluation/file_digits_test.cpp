// The digits of a points file: rounding can hide form or make it, and a verdict that hangs on it is
// none.

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/internal/file_digits.h"
#include "tests/evaluation/points_run.h"

namespace rondure::reports {
namespace {

using evaluation::Verdict;
using ::testing::HasSubstr;

/// A part of some 10 um form whose coordinates are rounded to steps; 0: as they are.
record::RunRecord rounded_run(double step_mm) {
  auto points = rough_part(7, 4, 24, core::kTwoPi);
  for (Eigen::Vector3d& point : points) {
    for (double& number : point) {
      if (step_mm > 0.0) number = step_mm * std::round(number / step_mm);
    }
  }
  record::RunRecord out = points_run(points, 4);
  out.features[0].characteristics.resize(1);
  return out;
}

evaluation::CharacteristicResult judged(double step_mm, double tolerance_mm) {
  record::RunRecord run = rounded_run(step_mm);
  run.features[0].characteristics[0].tolerance_mm = tolerance_mm;
  return evaluated(run).features[0].characteristics[0];
}

double step_of(double step_mm) {
  const record::RunRecord run = rounded_run(step_mm);
  return evaluation::step_of_file_mm(run, run.features[0].id);
}

TEST(FileDigits, AreFoundInMillimetresAndInches) {
  EXPECT_NEAR(step_of(0.01), 0.01, 1e-12);
  EXPECT_NEAR(step_of(0.001), 0.001, 1e-12);
  EXPECT_NEAR(step_of(1e-4), 1e-4, 1e-12);
  EXPECT_NEAR(step_of(0.0254), 0.0254, 1e-12);
  EXPECT_NEAR(step_of(0.00254), 0.00254, 1e-12);
  EXPECT_EQ(step_of(1e-5), 0.0);
  EXPECT_EQ(step_of(0.0), 0.0);
  EXPECT_EQ(step_of(0.5), 0.0) << "constructed points";
  record::RunRecord run = rounded_run(0.01);
  EXPECT_EQ(evaluation::step_of_file_mm(run, "another"), 0.0);
  run.touches.resize(3);  // 9 numbers: whole by chance
  EXPECT_EQ(evaluation::step_of_file_mm(run, run.features[0].id), 0.0);
}

TEST(FileDigits, LeaveAVerdictOnlyWhereTheyCannotTurnIt) {
  const double value_mm = *judged(0.001, 1.0).value_mm();
  for (const double beyond_mm : {0.001, -0.001}) {  // less than 1.41 steps
    const auto near = judged(0.001, value_mm + beyond_mm);
    EXPECT_EQ(near.verdict, Verdict::kUndecided) << beyond_mm;
    EXPECT_THAT(near.reason.english(), HasSubstr("steps of 1 um"));
    EXPECT_THAT(near.reason.english(), HasSubstr("1.414 um"));
  }
  EXPECT_EQ(judged(0.001, value_mm + 0.0015).verdict, Verdict::kConforms);
  EXPECT_EQ(judged(0.001, value_mm - 0.0015).verdict, Verdict::kDoesNotConform);
  // Steps far below the tolerance, and whatever digits a file has that rounds nothing.
  EXPECT_EQ(judged(1e-4, *judged(1e-4, 1.0).value_mm() + 1e-5).verdict, Verdict::kConforms);
  EXPECT_EQ(judged(0.0, *judged(0.0, 1.0).value_mm() + 1e-6).verdict, Verdict::kConforms);
}

// 14 um of form in a file of hundredths: rounding may have taken them for 3 um.
TEST(FileDigits, OfHundredthsProveNoTightTolerance) {
  const auto found = judged(0.01, 0.02);
  ASSERT_LT(*found.value_mm(), 0.02);
  EXPECT_EQ(found.verdict, Verdict::kUndecided);
  EXPECT_EQ(judged(0.01, 0.1).verdict, Verdict::kConforms);
}

TEST(FileDigits, HoldForASizeToo) {
  record::RunRecord run = rounded_run(0.01);
  record::Characteristic& size = run.features[0].characteristics[0];
  size.form = record::Form::kDiameter;
  size.tolerance_mm = 100.0;
  const auto far = evaluated(run).features[0].characteristics[0];
  ASSERT_TRUE(far.value) << far.reason.english();
  EXPECT_EQ(far.verdict, Verdict::kConforms);
  size.tolerance_mm = *far.value_mm() + 0.01;
  EXPECT_EQ(evaluated(run).features[0].characteristics[0].verdict, Verdict::kUndecided);
}

}  // namespace
}  // namespace rondure::reports
