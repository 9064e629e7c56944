#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rondure::core {

// Statistics of a series. Sums run from the first value to the last: same input, same bits.

/// Arithmetic mean; not a number for an empty series.
[[nodiscard]] double mean(std::span<const double> values);

/// Square root of the mean of the squares; 0 for an empty series.
[[nodiscard]] double root_mean_square(std::span<const double> values);

/// Standard deviation of a sample about its mean(), with n - 1 degrees of freedom; not a number or
/// infinite for n < 2.
[[nodiscard]] double standard_deviation(std::span<const double> values, double mean);

/// The value with `rank` others before it in ascending order; rank < size. O(n).
[[nodiscard]] double order_statistic(std::vector<double> values, std::size_t rank);

/// The value in the middle of an odd number, the mean of the two in the middle of an even one; n
/// >= 1. O(n).
[[nodiscard]] double median(std::vector<double> values);

/// The value in the middle, or the upper one of two; n >= 1. O(n).
[[nodiscard]] double upper_median(std::vector<double> values);

/// Standard deviation of a normal distribution over its median absolute deviation, 1 / 0.6745.
inline constexpr double kSigmaPerMedianDeviation = 1.4826;

/// The value below which a chi-square variable of `degrees_of_freedom` > 0 stays with this
/// probability; 0 < p < 1.
[[nodiscard]] double chi_square_quantile(double probability, double degrees_of_freedom);

}  // namespace rondure::core
