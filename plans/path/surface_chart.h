#pragma once

#include <Eigen/Core>

#include "plans/path/sampling.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// Where the targets of a feature lie on its nominal surface, and where the free side is. Part
/// frame.
class SurfaceChart {
 public:
  /// A round surface about the part axis.
  SurfaceChart(double radius_mm, bool inside) : radius_mm_(radius_mm), inside_(inside) {}
  explicit SurfaceChart(const FeaturePlan& feature);

  /// A cylinder or circle: everything about it follows from its radius.
  [[nodiscard]] bool is_round() const;
  [[nodiscard]] record::Shape shape() const { return shape_; }
  /// Of a plane: whether its free side is above.
  [[nodiscard]] bool faces_up() const { return faces_ == record::Faces::kUp; }

  [[nodiscard]] Eigen::Vector3d contact_point(const Target& target) const;
  /// Unit vector from the contact point into the free side.
  [[nodiscard]] Eigen::Vector3d normal(const Target& target) const;
  /// Unit vector of the search, opposite to the normal.
  [[nodiscard]] Eigen::Vector3d approach(const Target& target) const;
  /// Centre of a ball of this radius that stands off the surface by `gap_mm`.
  [[nodiscard]] Eigen::Vector3d tip(const Target& target, double tip_radius_mm,
                                    double gap_mm) const;

  friend bool operator==(const SurfaceChart&, const SurfaceChart&) = default;

 private:
  [[nodiscard]] double ring_radius_mm(const Target& target) const;

  record::Shape shape_ = record::Shape::kCylinder;
  double radius_mm_ = 0.0;  ///< Of a cone at `from_mm_`, of a plane of its innermost circle.
  bool inside_ = false;
  record::Faces faces_ = record::Faces::kUp;
  double from_mm_ = 0.0;
  double half_angle_rad_ = 0.0;
  double step_mm_ = 0.0;  ///< Between neighbouring circles of a plane.
  Eigen::Vector3d center_mm_ = Eigen::Vector3d::Zero();
};

}  // namespace rondure::plans
