#pragma once

#include "core/result.h"

namespace rondure::fit {

/// Where the material of a feature of size lies, and the ball that touched it.
struct Material {
  bool inside = false;         ///< True for a bore: the material is outside the cylinder.
  double tip_radius_mm = 0.0;  ///< Of the ball whose centres are evaluated [mm]; >= 0.

  /// +1 for a shaft, -1 for a bore: outward is out of the material.
  [[nodiscard]] double sign() const { return inside ? -1.0 : 1.0; }
  /// Radius of the surface, which lies one tip radius closer to the material than the tip centres.
  [[nodiscard]] double surface_radius_mm(double center_radius_mm) const {
    return center_radius_mm - sign() * tip_radius_mm;
  }
  /// Diameter of the surface for the radius of a cylinder of tip centres [mm].
  [[nodiscard]] double diameter_mm(double center_radius_mm) const {
    return 2.0 * surface_radius_mm(center_radius_mm);
  }
};

/// @return kBadOption if the tip radius is negative or not finite.
[[nodiscard]] core::Result<void> check_material(const Material& material);
/// The same; kBadOption also if the surface of a circle or cylinder of tip centres of this radius
/// would have none, which tells of a wrong tip or side.
[[nodiscard]] core::Result<void> check_material(const Material& material, double center_radius_mm);

}  // namespace rondure::fit
