#include "fit/contour/crank_motion.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/units.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {

core::Result<void> check_geometry(const CrankGeometry& geometry) {
  const std::array<std::pair<std::string_view, double>, 3> radii = {
      {{"crank radius", geometry.crank_radius_mm},
       {"wheel radius", geometry.wheel_radius_mm},
       {"pin radius", geometry.pin_radius_mm}}};
  for (const auto& [name, value] : radii) {
    if (!std::isfinite(value)) {
      return core::fail_with(core::Code::kNotFinite, "the {} is {}; a number in mm is needed", name,
                             value);
    }
    if (value <= 0.0) {
      return core::fail_with(core::Code::kOutOfRange, "the {} is {} mm; it must be above 0 mm",
                             name, value);
    }
  }
  if (geometry.crank_radius_mm < geometry.center_distance_mm()) return {};
  return core::fail_with(
      core::Code::kOutOfRange,
      "the crank radius is {} mm and the wheel and pin radii add up to {} mm; the wheel can follow "
      "the pin only where the crank radius is the smaller one",
      geometry.crank_radius_mm, geometry.center_distance_mm());
}

double wheel_position_mm(const CrankGeometry& geometry, double alpha_rad) {
  const double across = geometry.crank_radius_mm * std::sin(alpha_rad);
  const double length = geometry.center_distance_mm();
  return geometry.crank_radius_mm * std::cos(alpha_rad) +
         std::sqrt((length - across) * (length + across));
}

double contact_angle_rad(const CrankGeometry& geometry, double alpha_rad) {
  return alpha_rad +
         std::asin(geometry.crank_radius_mm * std::sin(alpha_rad) / geometry.center_distance_mm());
}

double pressure_angle_rad(const CrankGeometry& geometry, double beta_rad) {
  return std::atan2(geometry.crank_radius_mm * std::sin(beta_rad),
                    geometry.center_distance_mm() + geometry.crank_radius_mm * std::cos(beta_rad));
}

double command_angle_rad(const CrankGeometry& geometry, double beta_rad) {
  return beta_rad - pressure_angle_rad(geometry, beta_rad);
}

ContourSensitivity contour_sensitivity(const CrankGeometry& geometry, double beta_rad) {
  return {std::cos(pressure_angle_rad(geometry, beta_rad)),
          geometry.crank_radius_mm * std::sin(beta_rad)};
}

std::vector<double> x_compensation_mm(const CrankGeometry& geometry,
                                      std::span<const double> error_mm, std::size_t count) {
  std::vector<double> beta(error_mm.size());
  for (std::size_t i = 0; i < beta.size(); ++i) {
    beta[i] = core::kTwoPi * static_cast<double>(i) / static_cast<double>(beta.size());
  }
  const PeriodicSpline error(beta, {error_mm.begin(), error_mm.end()});
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha = core::kTwoPi * static_cast<double>(i) / static_cast<double>(count);
    const double contact = contact_angle_rad(geometry, alpha);
    out[i] = -error(contact) / std::cos(contact - alpha);
  }
  return out;
}

}  // namespace rondure::fit
