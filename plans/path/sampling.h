#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "plans/plan.h"

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

}  // namespace rondure::plans
