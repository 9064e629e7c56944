#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/sections.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/form_parameters.h"

namespace rondure::fit {

/// Straightness of one generatrix in the plane through the axis (ISO 12780-1).
struct GeneratrixStraightness {
  FormParameters ls;      ///< STRt, STRp, STRv, STRq about the least-squares line.
  double zone_mm = 0.0;   ///< STRt about the minimum-zone line: least distance of two parallels.
  double ls_slope = 0.0;  ///< Radius per length of the least-squares line.
};

/// Computes the straightness of a generatrix. Deviations are measured perpendicular to the lines.
/// The zone is exact: the narrowest strip over all directions, which is the least width of the
/// convex hull and is attained at an edge. O(n log n).
/// @param z_mm  Positions along the axis; n >= 3, at least two different [mm].
/// @param r_mm  Distances from the axis there [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (all at one position).
/// Source of the zone: M. E. Houle, G. T. Toussaint, IEEE Trans. PAMI 10 (1988) 761-765.
[[nodiscard]] core::Result<GeneratrixStraightness> generatrix_straightness(
    std::span<const double> z_mm, std::span<const double> r_mm);

/// Taper of a cylinder about its axis: the radii are fitted by r = r0 + slope z (least squares).
struct Taper {
  double slope = 0.0;        ///< Radius per length along the axis direction; > 0: widening.
  double diameter_mm = 0.0;  ///< Change of the diameter over the length of the data, signed [mm].
  double cone_angle_rad = 0.0;  ///< Angle between opposite generatrices, signed: 2 atan(slope).
};

/// Computes the taper of points about an axis.
/// @return kNoPoints, kNotFinite (row), kRank (all points in one section).
[[nodiscard]] core::Result<Taper> taper(SpacePoints points_mm, const Axis& axis);

/// The points of one generatrix: those of all layers at one angle about the axis, as measured.
struct Generatrix {
  double angle_rad = 0.0;            ///< In the frame of across() [rad].
  std::vector<double> heights_mm;    ///< Along the axis, from its point [mm].
  std::vector<double> distances_mm;  ///< From the axis [mm].
};

/// Collects the generatrices of touched layers that begin at the same angle.
/// @param axis  Least-squares axis of the feature.
/// @return One for each angle of the first layer at which every layer has a point within 0.5 deg,
/// in
///         its order: those through a window are omitted. kNoPoints (no layer), kNotFinite (row),
///         kSampling if there is no such angle (staggered layers).
/// Source: methods, drawing sections 4.2 and 7.
[[nodiscard]] core::Result<std::vector<Generatrix>> generatrices(Layers layers_mm,
                                                                 const Axis& axis);

/// A dense section of a feature, whose profile is known at every angle by its harmonic series.
struct DenseSection {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< Of its circle, as Section::circle.
  double height_mm = 0.0;                               ///< Mean height along the axis [mm].
  UniformProfile profile;  ///< Radii about that centre, filtered or not; >= 8 samples [mm].
};

/// Generatrices of dense sections at `count` uniform angles about the axis; nothing is interpolated
/// between points, as the harmonic series gives the surface at every angle.
/// @return count generatrices from angle 0 on; kNoPoints (no section), kSampling (fewer than 8
///         samples; `what` names the section), kBadOption (count < 1). O(count n) for each section.
/// Source: methods, drawing section 4.2.
[[nodiscard]] core::Result<std::vector<Generatrix>> dense_generatrices(
    std::span<const DenseSection> sections, int count = 36);

/// Two opposite generatrices in a plane through the axis.
struct OppositeGeneratrices {
  double angle_rad = 0.0;  ///< Of the first of the two.
  /// Local cylinder taper (ISO 12180-1): half the change of the local diameter over the length,
  /// from the least-squares lines [mm].
  double taper_mm = 0.0;
  /// Greatest range of the distances of one generatrix from the line of the other, over both
  /// choices of the datum line [mm].
  double parallelism_mm = 0.0;
};

/// Taper and parallelism in every plane through the axis that holds two generatrices opposite each
/// other to 0.5 deg. The cylinder taper is the greatest of the local ones.
/// @param length_mm  Extent of the feature along the axis; > 0.
/// @return One for each plane, by the first generatrix; kSampling if no two are opposite, kRank.
/// Source: methods, drawing section 4.4.
[[nodiscard]] core::Result<std::vector<OppositeGeneratrices>> opposite_generatrices(
    std::span<const Generatrix> lines, double length_mm);

}  // namespace rondure::fit
