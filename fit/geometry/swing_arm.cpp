#include "fit/geometry/swing_arm.h"

#include <cmath>

#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr double kGreatestWheel = 2000.0;
constexpr double kGreatestPin = 1000.0;

/// Returns `angle` shifted by whole turns to be nearest to `near`.
double unwrapped(double angle, double near) {
  return angle + core::kTwoPi * std::round((near - angle) / core::kTwoPi);
}

}  // namespace

double SwingArm::beta_rad(double alpha_rad) const {
  return swings() ? std::asin(crank_radius_mm * std::sin(alpha_rad) / center_distance_mm()) : 0.0;
}

double SwingArm::alpha_of_theta_rad(double theta_rad) const {
  if (!swings()) return theta_rad;
  const double length = center_distance_mm();
  const double alpha =
      std::atan2(length * std::sin(theta_rad), crank_radius_mm + length * std::cos(theta_rad));
  return unwrapped(alpha, theta_rad);  // |beta| < 90 deg
}

double SwingArm::beta_of_theta_rad(double theta_rad) const {
  if (!swings()) return 0.0;
  return std::atan2(crank_radius_mm * std::sin(theta_rad),
                    center_distance_mm() + crank_radius_mm * std::cos(theta_rad));
}

core::Result<void> check_swing_arm(const SwingArm& arm) {
  for (const double length : {arm.crank_radius_mm, arm.wheel_radius_mm, arm.pin_radius_mm}) {
    if (std::isfinite(length) && length >= 0.0) continue;
    return core::fail_with(
        core::Code::kOutOfRange,
        "a radius of {} mm is none; give crank, wheel and pin radius in mm, not below 0", length);
  }
  if (arm.wheel_radius_mm > kGreatestWheel || arm.pin_radius_mm > kGreatestPin) {
    return core::fail_with(core::Code::kUnits,
                           "a wheel radius of {:g} mm and a pin radius of {:g} mm suggest um; give "
                           "them in mm, at most {:g} and {:g} mm",
                           arm.wheel_radius_mm, arm.pin_radius_mm, kGreatestWheel, kGreatestPin);
  }
  if (!arm.swings()) return {};
  if (!(arm.wheel_radius_mm > 0.0) || !(arm.pin_radius_mm > 0.0)) {
    return core::fail_with(
        core::Code::kOutOfRange,
        "an arm that swings needs wheel and pin: wheel radius {:g} mm, pin radius {:g} mm",
        arm.wheel_radius_mm, arm.pin_radius_mm);
  }
  if (arm.crank_radius_mm >= arm.center_distance_mm()) {
    return core::fail_with(core::Code::kOutOfRange,
                           "the crank radius {:g} mm is not below wheel radius + pin radius = {:g} "
                           "mm; the pin would pass the wheel centre",
                           arm.crank_radius_mm, arm.center_distance_mm());
  }
  return {};
}

}  // namespace rondure::fit
