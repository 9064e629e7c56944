#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/result.h"

// Statistics of a sequence of form deviations. They are positive, skewed and bounded by zero, so
// they are not treated as normal: all statistics use their logarithms. docs/archive.md has the
// formulas and the reasons.

namespace rondure::reports {

/// With fewer results there are no control limits; below the second number they are provisional.
inline constexpr std::size_t kLeastForLimits = 10;
inline constexpr std::size_t kEnoughForLimits = 25;
/// With fewer results there is no capability index; below the second number it is a rough estimate.
inline constexpr std::size_t kLeastForIndex = 25;
inline constexpr std::size_t kEnoughForIndex = 50;
/// From this number on the sample itself gives the 99.865 % point.
inline constexpr std::size_t kEnoughForSample = 1000;

/// Limits of a chart of individual values.
struct ControlLimits {
  double lower_mm = 0.0;
  double center_mm = 0.0;
  double upper_mm = 0.0;
};

/// Control limits of individuals and moving ranges (I-MR chart), computed for ln x and transformed
/// back: exp(mean +- 3 MR / 1.128), MR the mean of |ln x_i - ln x_(i-1)|.
///
/// @param values_mm  In the order of time, > 0.
/// @return  kTooFewPoints below kLeastForLimits, kOutOfRange for a value that is not positive,
///          kRank when all values are equal. O(n). Source: ISO 7870-2:2013, individuals chart.
[[nodiscard]] core::Result<ControlLimits> control_limits(std::span<const double> values_mm);

/// Index of how far the values stay within their limits, relative to their spread.
struct Capability {
  enum class Method {
    kLogNormal,  ///< Percentiles of the log-normal distribution fitted to the values.
    kSample,     ///< Percentiles of the values themselves.
  };
  Method method = Method::kLogNormal;
  /// (U - x50) / (x99.865 - x50), (x50 - L) / (x50 - x0.135), or the lesser of both.
  double index = 0.0;
  std::optional<double> lower_bound;  ///< One-sided 95 % confidence; for the log-normal model only.
  double median_mm = 0.0;             ///< x50
  double upper_point_mm = 0.0;        ///< x99.865
  std::optional<double> lower_point_mm = {};  ///< x0.135, where there is a lower limit.
  double fit_p = 0.0;                         ///< p of the Anderson-Darling test of ln x.
};

/// The index by the percentile method (ISO 22514-2) above a lower limit (PpkL), below an upper one
/// (PpkU), or between both (Ppk). It is called Cpk when the process is shown to be in statistical
/// control, which the caller decides. The log-normal model is used when the
/// Anderson-Darling test does not reject it (p >= 0.05); otherwise the sample's own percentiles,
/// from kEnoughForSample values on.
///
/// The lower bound is a generalised confidence limit (S. Weerahandi, J. Am. Stat. Assoc. 88, 1993).
///
/// @pre At least one limit.
/// @return  kTooFewPoints below kLeastForIndex, kOutOfRange for a value that is not positive, kRank
///          when all values are equal, kNotConverged when the model does not fit and there are too
///          few values for their own percentiles. O(n log n).
[[nodiscard]] core::Result<Capability> capability_between(std::span<const double> values_mm,
                                                          const std::optional<double>& lower_mm,
                                                          const std::optional<double>& upper_mm);

/// p of the Anderson-Darling test that the values come from a normal distribution whose mean and
/// standard deviation are estimated from them. n >= 8 values, not all equal.
/// Source: R. B. D'Agostino, M. A. Stephens, Goodness-of-Fit Techniques, 1986, table 4.9.
[[nodiscard]] double anderson_darling_p(std::span<const double> values);

}  // namespace rondure::reports
