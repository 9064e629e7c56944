#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/section.h"

namespace rondure::reports {

/// Positions in the drawing in three dimensions, in px about its centre. Cylindrical coordinates
/// about the minimum-zone axis, which is drawn upright.
struct SolidPoint {
  std::size_t row = 0;  ///< Row of the cloud.
  double angle_deg = 0.0;
  double radius = 0.0;
  double height = 0.0;
};

/// A closed line about the axis: one radius for a circle, or one every 3 deg, with NaN where
/// nothing was measured.
struct SolidRing {
  double height = 0.0;
  std::vector<double> radii;
};

/// A cylinder feature prepared for drawing in three dimensions.
struct SolidScene {
  double inner = 0.0;          ///< Radius of the inner cylinder of the zone.
  double outer = 0.0;          ///< Radius of the outer one.
  double half_height = 0.0;    ///< The cylinders reach from minus to plus this.
  double magnification = 1.0;  ///< Magnification of deviations relative to the radius.
  /// Scale of heights relative to that of the radius; 1: true proportions.
  double height_share = 1.0;
  double low_mm = 0.0;   ///< Height of the lower end, from the mean point.
  double high_mm = 0.0;  ///< Height of the upper end.
  std::vector<SolidPoint> points;
  std::size_t left_out = 0;  ///< Points of the cloud that are not drawn.
  std::vector<SolidRing> sections;
  bool dense = false;  ///< The points of a section are as close as its line.
};

/// More points than this are thinned: every contact point stays, and from each cell of 5 deg by
/// 1/24 of the height the point farthest from the middle of the zone.
inline constexpr std::size_t kMostSolidPoints = 1200;

/// @param feature  Its cloud must have more than one height.
[[nodiscard]] SolidScene solid_scene_of(const evaluation::FeatureResult& feature,
                                        const evaluation::Zone& zone);

/// The view: turned about the axis, then tilted towards the reader; parallel projection.
/// html/internal/script.h repeats it.
struct SolidCamera {
  double yaw_deg = -60.0;
  double pitch_deg = 22.0;
};

/// A projected place, px about the centre of the drawing, y downwards.
struct SolidSeen {
  double x = 0.0;
  double y = 0.0;
  bool faces = true;  ///< The place is on the half of the cylinder that faces the reader.
};
[[nodiscard]] SolidSeen seen(const SolidCamera& camera, double angle_deg, double radius,
                             double height);

}  // namespace rondure::reports
