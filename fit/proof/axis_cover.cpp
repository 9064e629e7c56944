#include "fit/proof/axis_cover.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "fit/geometry/axis.h"

namespace rondure::fit {

Eigen::Vector3d DirectionBox::direction(double x, double y) const {
  return (frame * Eigen::Vector3d(center.x() + x, center.y() + y, 1.0)).normalized();
}

double DirectionBox::opening_rad() const {
  const Eigen::Vector3d axis = middle();
  double largest = 0.0;
  for (const double x : {-half_side, half_side}) {
    for (const double y : {-half_side, half_side}) {
      // Computed from the sine, as the cosine of a small angle has lost its digits.
      largest = std::max(largest, std::asin(std::min(1.0, axis.cross(direction(x, y)).norm())));
    }
  }
  return largest;
}

std::array<DirectionBox, 4> DirectionBox::quarters() const {
  const double half = 0.5 * half_side;
  const auto quarter = [&](double x, double y) -> DirectionBox {
    return {frame, center + Eigen::Vector2d(x, y), half};
  };
  return {quarter(-half, -half), quarter(-half, half), quarter(half, -half), quarter(half, half)};
}

std::vector<DirectionBox> cover_cone(const Eigen::Vector3d& direction, double cone_rad) {
  DirectionBox box;
  box.frame << across(direction.normalized()), direction.normalized();
  box.half_side = std::tan(cone_rad);
  return {box};
}

std::vector<DirectionBox> cover_half_sphere() {
  std::vector<DirectionBox> out(3);
  for (int face = 0; face < 3; ++face) {
    auto& box = out[static_cast<std::size_t>(face)];
    box.frame << across(Eigen::Vector3d::Unit(face)), Eigen::Vector3d::Unit(face);
    box.half_side = 1.0;
  }
  return out;
}

}  // namespace rondure::fit
