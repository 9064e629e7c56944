#include "fit/contour/crank_motion.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace rondure::fit {

core::Result<void> check_geometry(const CrankGeometry& geometry) {
  const std::array<std::pair<std::string_view, double>, 3> radii = {
      {{"crank radius", geometry.crank_radius_mm},
       {"wheel radius", geometry.wheel_radius_mm},
       {"pin radius", geometry.pin_radius_mm}}};
  for (const auto& [name, value] : radii) {
    if (!std::isfinite(value)) {
      return core::fail(core::Code::kNotFinite,
                        fmt::format("the {} is {}; a number in mm is needed", name, value));
    }
    if (value <= 0.0) {
      return core::fail(core::Code::kOutOfRange,
                        fmt::format("the {} is {} mm; it must be above 0 mm", name, value));
    }
  }
  if (geometry.crank_radius_mm < geometry.center_distance_mm()) return {};
  return core::fail(
      core::Code::kOutOfRange,
      fmt::format(
          "the crank radius is {} mm and the wheel and pin radii add up to {} mm; the wheel "
          "can follow the pin only where the crank radius is the smaller one",
          geometry.crank_radius_mm, geometry.center_distance_mm()));
}

double wheel_position_mm(const CrankGeometry& geometry, double alpha_rad) {
  const double across = geometry.crank_radius_mm * std::sin(alpha_rad);
  const double length = geometry.center_distance_mm();
  return geometry.crank_radius_mm * std::cos(alpha_rad) +
         std::sqrt((length - across) * (length + across));
}

double pressure_angle_rad(const CrankGeometry& geometry, double beta_rad) {
  return std::atan2(geometry.crank_radius_mm * std::sin(beta_rad),
                    geometry.center_distance_mm() + geometry.crank_radius_mm * std::cos(beta_rad));
}

double command_angle_rad(const CrankGeometry& geometry, double beta_rad) {
  return beta_rad - pressure_angle_rad(geometry, beta_rad);
}

}  // namespace rondure::fit
