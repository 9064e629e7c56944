#pragma once

#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// A crank pin in follow grinding. The crankshaft turns about O, and the wheel head keeps the wheel
/// tangent to the pin, whose centre moves about O at the crank radius R. In the frame of the
/// crankshaft (x axis from O to the pin centre Op) the wheel centre moves about both.
struct CrankGeometry {
  double crank_radius_mm = 49.0;    ///< R, distance of the pin centre from O.
  double wheel_radius_mm = 299.88;  ///< Rgw.
  double pin_radius_mm = 24.56;     ///< r.

  /// Lc = Rgw + r, distance of the wheel centre from the pin centre [mm].
  [[nodiscard]] double center_distance_mm() const { return wheel_radius_mm + pin_radius_mm; }
};

/// @return kNotFinite; kOutOfRange for a radius that is not positive, or for R >= Lc, where the
///         wheel cannot follow the pin all round.
[[nodiscard]] core::Result<void> check_geometry(const CrankGeometry& geometry);

// Precondition of the functions below: check_geometry() accepts the geometry. Angles may span any
// number of turns; the resulting angles then do so as well.

/// X position d of the wheel centre, its distance from O, at the C position alpha [mm]:
/// d = R cos(alpha) + sqrt(Lc^2 - R^2 sin^2(alpha)).
[[nodiscard]] double wheel_position_mm(const CrankGeometry& geometry, double alpha_rad);

/// Polar angle beta about the pin centre where the wheel touches at the C position alpha.
[[nodiscard]] double contact_angle_rad(const CrankGeometry& geometry, double alpha_rad);

/// C position alpha at which the polar angle beta is ground; the inverse of contact_angle_rad().
[[nodiscard]] double command_angle_rad(const CrankGeometry& geometry, double beta_rad);

/// Pressure angle eta = beta - alpha: between the X axis and the contact normal.
[[nodiscard]] double pressure_angle_rad(const CrankGeometry& geometry, double beta_rad);

/// Effect of axis errors on the contour, to first order: dr = x dd + c_mm dalpha.
struct ContourSensitivity {
  double x = 1.0;     ///< cos(eta), per mm of X.
  double c_mm = 0.0;  ///< R sin(beta), per rad of C [mm].
};
[[nodiscard]] ContourSensitivity contour_sensitivity(const CrankGeometry& geometry,
                                                     double beta_rad);

/// Correction of the X command that removes a contour error, to first order:
/// dd(alpha) = -f(beta(alpha)) / cos(eta).
///
/// @param error_mm  f at the angles 360 m / M deg, M >= 3.
/// @param count     Number of values to return, at the C positions 360 i / count deg.
[[nodiscard]] std::vector<double> x_compensation_mm(const CrankGeometry& geometry,
                                                    std::span<const double> error_mm,
                                                    std::size_t count);

// Source: methods, contour sections 1, 2 and 5.

}  // namespace rondure::fit
