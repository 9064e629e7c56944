#include "core/statistics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

TEST(Statistics, MeanAndSpreadOfAFewValues) {
  const std::vector<double> values = {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  EXPECT_EQ(mean(values), 5.0);
  EXPECT_EQ(root_mean_square(values), std::sqrt(29.0));
  EXPECT_EQ(root_mean_square({}), 0.0);
  EXPECT_EQ(standard_deviation(values, 5.0), std::sqrt(32.0 / 7.0));
}

TEST(Statistics, MedianOfAnEvenNumberLiesBetweenTheTwoInTheMiddle) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(upper_median({4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(upper_median({7.0}), 7.0);
  EXPECT_EQ(order_statistic({4.0, 1.0, 3.0, 2.0}, 0), 1.0);
  EXPECT_EQ(order_statistic({4.0, 1.0, 3.0, 2.0}, 3), 4.0);
}

// Tables of M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 26.8; ln 4 in closed
// form.
TEST(Statistics, ChiSquareQuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(0.999, 3), 16.266236, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.999, 6), 22.457744, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841459, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.5, 2), 2.0 * std::log(2.0), 1e-14);
  EXPECT_NEAR(chi_square_quantile(0.95, 100), 124.342113, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.999, 1000), 1143.917, 1e-3);
}

}  // namespace
}  // namespace rondure::core
