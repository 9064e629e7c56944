#pragma once

#include "core/result.h"

namespace rondure::fit {

/// The swing arm of a probe head that follows a crank pin: its pivot is the wheel centre O1, on the
/// horizontal line through the rotation axis O, and the arm points to the pin centre A.
///
///     R sin(alpha) = Lc sin(beta),   theta = alpha + beta
///
/// alpha is the rotation of the work (0 where O, A, O1 are in line, A between), beta the swing of
/// the arm, theta the travel of probe 1 over the pin. With R = 0 (an ordinary shaft) or a fixed
/// arm, beta = 0 and theta = alpha. Source: methods, roundness A.2.
///
/// @pre check_swing_arm() accepts the arm, for all functions of an angle.
struct SwingArm {
  double crank_radius_mm = 0.0;  ///< R, >= 0.
  double wheel_radius_mm = 0.0;  ///< Rs.
  double pin_radius_mm = 0.0;    ///< Rw; the second order needs it for an ordinary shaft as well.

  /// Lc: distance between pivot and pin centre [mm].
  [[nodiscard]] double center_distance_mm() const { return wheel_radius_mm + pin_radius_mm; }
  /// Whether the arm swings.
  [[nodiscard]] bool swings() const { return crank_radius_mm > 0.0; }

  [[nodiscard]] double beta_rad(double alpha_rad) const;
  /// Continuous over any number of turns.
  [[nodiscard]] double alpha_of_theta_rad(double theta_rad) const;
  [[nodiscard]] double beta_of_theta_rad(double theta_rad) const;
};

/// Checks the dimensions: kOutOfRange for a negative or not finite one, for R >= Lc, and for a
/// swinging arm without wheel or pin; kUnits for a wheel above 2 m or a pin above 1 m, which
/// suggest micrometres.
[[nodiscard]] core::Result<void> check_swing_arm(const SwingArm& arm);

}  // namespace rondure::fit
