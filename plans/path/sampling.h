#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// A point on the nominal surface to be touched, in the part frame (z along the part axis, heights
/// as in the plan).
struct Target {
  int layer = 0;  ///< 0 is the lowest.
  int point = 0;  ///< Index within the layer.
  double theta_rad = 0.0;
  double z_mm = 0.0;

  friend bool operator==(const Target&, const Target&) = default;
};

/// The length on which the layers of a feature lie: along the axis, of a plane along its radius.
[[nodiscard]] double layered_mm(const FeaturePlan& feature);

/// Heights of the layers of a feature, from below, however many points lie on them [mm].
/// @return  As for sampling_targets().
[[nodiscard]] core::Result<std::vector<double>> layer_heights_mm(const FeaturePlan& feature);

/// The targets of a feature, layer by layer from below, by angle within a layer:
///   z_j = from + margin + j (to - from - 2 margin) / (m - 1)
///   theta_ji = start + 360 deg (i / k + stagger j / (m k)).
/// A single layer, as for a circle, is in the middle. The layers of a plane are circles, the
/// innermost first, all at its height; SurfaceChart knows their radii.
/// @return  kSampling when the layers or points cannot be placed.
/// Source: methods, cylindricity section 4.
[[nodiscard]] core::Result<std::vector<Target>> sampling_targets(const FeaturePlan& feature);

/// Targets that locate the part before it is measured: two layers of three points, offset by 60 deg
/// from one another. A cylinder has five unknowns (two crossings of its axis with two planes, and
/// the radius). Three points per layer give a crossing and a radius each, so the six touches
/// determine all five and leave one check, that both layers have the same radius. The variance of a
/// crossing is 2/3 of that of a touch in every direction. The layers keep a distance from both ends
/// of the margin plus the largest deviation of the surface from nominal, so that a crooked part is
/// touched on its side and not on its rim.
/// @return  As for sampling_targets().
[[nodiscard]] core::Result<std::vector<Target>> locating_targets(const FeaturePlan& feature,
                                                                 double uncertainty_mm);
/// Three targets on the middle circle of a plane, which show its height.
[[nodiscard]] core::Result<std::vector<Target>> height_targets(const FeaturePlan& face);

/// Directions for touching a reference sphere: unit vectors from its centre, all in the upper half
/// space, the pole first, then rings from above down to the equator, spread evenly over the
/// hemisphere. Fewer than 9 points are the pole and points on the equator.
/// @param points  5..100, otherwise kSampling.
[[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> qualification_directions(int points);

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
