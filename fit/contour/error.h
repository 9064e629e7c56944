#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/profiles/harmonics.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::fit {

inline constexpr std::size_t kLeastContourPoints = 16;  ///< Least M of a contour.

/// Base circle that is removed from a contour.
enum class BaseCircle {
  kLimacon,    ///< Mean, cos and sin of the deviations; e^2/(2 r) off for an eccentricity e.
  kGeometric,  ///< Least-squares circle of the points; deviations about its own centre.
};

/// Settings of contour_error().
struct ContourErrorOptions {
  FilterOptions filter;  ///< Gaussian low pass, 50 UPR.
  BaseCircle base = BaseCircle::kLimacon;
  bool filtered_already = false;  ///< The values are already filtered: only remove the circle.
};

/// A contour error: deviations from the base circle at the angles 2 pi m / M, mean 0.
struct ContourError {
  std::vector<double> error_mm;
  double base_radius_mm = 0.0;
  Eigen::Vector2d base_center_mm = Eigen::Vector2d::Zero();
  double peak_to_valley_mm = 0.0;
  double rms_mm = 0.0;

  /// Angle of the greatest and of the least deviation [rad].
  [[nodiscard]] double crest_rad() const;
  [[nodiscard]] double valley_rad() const;
};

/// Peak to valley of a curve; 0 for an empty one.
[[nodiscard]] double peak_to_valley(std::span<const double> curve);

/// Filters a contour and removes its base circle.
///
/// @param deviation_mm  Radius minus nominal at 2 pi m / M, M >= 16 [mm].
/// @param nominal_mm    Radius from which the deviations count, > 0 [mm].
/// @return kTooFewPoints, kNotFinite (row), the errors of check_sampling() for M points and of
///         ls_circle().
/// Source: methods, contour section 4; roundness B.2.
[[nodiscard]] core::Result<ContourError> contour_error(std::span<const double> deviation_mm,
                                                       double nominal_mm,
                                                       const ContourErrorOptions& options = {});

/// Harmonics 2 .. highest of a contour error.
[[nodiscard]] std::vector<Harmonic> contour_harmonics(std::span<const double> error_mm,
                                                      int highest);

/// Parts of cos and sin of the harmonics 2 .. highest of a contour error, in turn: a2, b2, a3, b3,
/// ... of a cos(k beta) + b sin(k beta). @pre highest < M / 2.
[[nodiscard]] std::vector<double> contour_coefficients(std::span<const double> error_mm,
                                                       int highest);
/// The curve of such coefficients at the angles 2 pi m / samples. @pre samples above twice the
/// highest harmonic.
[[nodiscard]] std::vector<double> contour_of(std::span<const double> coefficients_mm,
                                             std::size_t samples);

/// A curve turned by an angle: out(theta) = curve(theta - angle), by its Fourier series.
[[nodiscard]] std::vector<double> turned_curve(std::span<const double> curve, double angle_rad);

}  // namespace rondure::fit
