#pragma once

#include <algorithm>
#include <memory>

#include <Eigen/Core>

#include "plans/path/revolved_mesh.h"
#include "plans/path/solid_mesh.h"

namespace rondure::plans {

/// A simple solid: a rectangle of the (r, z) half plane rotated about z (cylinder, ring, disc), the
/// same with a slanting outer wall (frustum of a cone), or a ball about the origin.
struct Revolved {
  double inner_mm = 0.0;  ///< Radius of the hole; 0: none.
  double outer_mm = 0.0;  ///< Outer radius, also of a ball.
  double from_mm = 0.0;   ///< Lower end; not for a ball.
  double to_mm = 0.0;
  bool ball = false;
  double widens_mm = 0.0;  ///< Outer radius at the upper end minus that at the lower one.
  /// A ball or frustum beside which paths are laid exactly at the limit: tangent planes are tried,
  /// too.
  bool touched = false;

  [[nodiscard]] double widest_mm() const { return outer_mm + std::max(0.0, widens_mm); }
};

/// Distance of a point from the solid, in its frame [mm]; 0 inside. Closed form.
[[nodiscard]] double distance_mm(const Revolved& solid, const Eigen::Vector3d& point_mm);

/// A solid with a clearance around it. A separating plane or cylinder answers most queries; the
/// rest use exact intersection with a mesh of the grown solid, built on first use. Not for use by
/// several threads at once.
class Obstacle {
 public:
  /// @param grown_mm  Clearance to keep, > 0.
  Obstacle(const Revolved& solid, double grown_mm);

  /// Whether any point of the sweep, in the frame of the solid, is closer to it than `grown_mm`.
  /// Never false when a point is closer by more than 1e-6 mm; may be true from up to 0.02 mm
  /// outside the limit at round walls, and up to 4 % of `grown_mm` outside it at edges.
  [[nodiscard]] bool meets(const Sweep& sweep) const;
  [[nodiscard]] double grown_mm() const { return grown_mm_; }

 private:
  [[nodiscard]] const RevolvedMesh& mesh() const;

  Revolved solid_;
  double grown_mm_;
  mutable std::unique_ptr<RevolvedMesh> mesh_;
};

}  // namespace rondure::plans
