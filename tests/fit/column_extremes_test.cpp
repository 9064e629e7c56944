#include "fit/geometry/column_extremes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"

namespace rondure::fit {
namespace {

std::vector<double> column(std::uint64_t seed, std::size_t count) {
  core::KeyedNoise noise(seed, {71, count});
  std::vector<double> out(count);
  for (double& v : out) v = noise.normal();
  return out;
}

TEST(ColumnExtremes, AreThoseOfAPlainLoopAtEveryLength) {
  for (std::size_t count = 1; count <= 40; ++count) {
    SCOPED_TRACE(count);
    const auto values = column(1, count);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const auto found = column_extremes(values);
    EXPECT_EQ(found.low, *low);
    EXPECT_EQ(found.high, *high);
    EXPECT_EQ(largest_magnitude(values), std::max(std::abs(*low), std::abs(*high)));
    EXPECT_EQ(first_row_of(values, *high), static_cast<std::size_t>(high - values.begin()));
  }
}

TEST(ColumnExtremes, NameTheFirstOfEqualRows) {
  std::vector<double> values(19, 1.0);
  values[11] = values[6] = 2.0;
  EXPECT_EQ(first_row_of(values, 2.0), 6U);
  EXPECT_EQ(first_row_of(values, 1.0), 0U);
}

TEST(ColumnExtremes, MovedColumnsAreThoseOfAPlainLoop) {
  for (std::size_t count = 1; count <= 21; ++count) {
    SCOPED_TRACE(count);
    const auto values = column(1, count), a = column(2, count), b = column(3, count);
    const std::array<const double*, 2> columns{a.data(), b.data()};
    const std::array<double, 2> move{0.3, -1.7};
    std::vector<double> moved(count), squares(count);
    const auto after = move_column<2>(values, columns.data(), move.data(), moved.data());
    const auto square = square_column<2>(count, columns.data(), move.data(), squares.data());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(moved[i], values[i] + a[i] * move[0] + b[i] * move[1]);
      const double x = a[i] - move[0], y = b[i] - move[1];
      EXPECT_EQ(squares[i], x * x + y * y);
    }
    EXPECT_EQ(after.high, *std::max_element(moved.begin(), moved.end()));
    EXPECT_EQ(after.low, *std::min_element(moved.begin(), moved.end()));
    EXPECT_EQ(square.high, *std::max_element(squares.begin(), squares.end()));
    EXPECT_EQ(square.low, *std::min_element(squares.begin(), squares.end()));
  }
}

TEST(ColumnExtremes, TheLargestMagnitudeIsNotFiniteWhereOneNumberIsNot) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (std::size_t at = 0; at < 11; ++at) {
      SCOPED_TRACE(at);
      auto values = column(4, 11);
      values[at] = bad;
      EXPECT_FALSE(std::isfinite(largest_magnitude(values)));
    }
  }
}

}  // namespace
}  // namespace rondure::fit
