#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"
#include "fit/zone/ending.h"

namespace rondure::fit {

/// How a datum axis is taken from the features (ISO 5459).
enum class DatumAssociation {
  /// Coaxial cylinders that touch each feature from outside the material: the least sum of radii
  /// (of bores: the greatest). For one feature the axis of GN or GX.
  kOneSided,
  /// The one-sided cylinders with the least sum of squared distances, whose radii sum to the
  /// optimum
  /// of the one-sided ones: in the middle of the positions between which a datum rocks.
  kEqualised,
  kLeastSquares,  ///< Least sum of squared distances, with a radius for each feature.
  kZone,          ///< Least sum of the widths of the zones.
};

/// A cylindrical datum feature.
struct DatumCylinder {
  SpacePoints points_mm;
  bool inside = false;  ///< True for a bore: the material is outside.
};

/// A datum axis common to one or more coaxial features.
struct DatumAxis {
  Axis axis;
  std::vector<double> radii_mm;   ///< Of each feature; for zones the mean of both sides [mm].
  std::vector<Contact> contacts;  ///< Rows of the features in order; none for least squares.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< Anything but kConverged: no datum to rely on.
};

/// Finds the datum axis of one cylinder (A) or the common one of several (A-B), as a single
/// constrained association: not the mean of two axes, nor the line through the middles of them.
///
/// @param features        One or more; in all at least two sections that surround the axis [mm].
/// @param near_direction  Start direction. Without it, that of the cylinder of one feature, or of
/// the
///                        line from the mean of the first feature to that of the last.
/// @return as ls_cylinder(); kNoPoints (no feature, or an empty one; `what` names it); kRank (one
///         section in all, several features with one mean); kReferenceAbsent for features that do
///         not surround the axis. The optimum is the one next to the least-squares axis.
///         O(n) per step, some ten steps.
/// Sources: ISO 5459; methods, drawing sections 3.1 to 3.3.
[[nodiscard]] core::Result<DatumAxis> datum_axis(
    std::span<const DatumCylinder> features, DatumAssociation association,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// How far a one-sided datum can rock.
struct DatumRock {
  /// Optimal sum of the radii to first order about the least-squares axis (bores count as negative)
  /// [mm].
  double sum_mm = 0.0;
  /// How far the ends of the datum move against each other over its length, among all positions
  /// whose radii sum to the optimum within 1e-5 mm [mm].
  double play_mm = 0.0;
};

/// @return as datum_axis(). Cost: five linear programmes.
/// Source: methods, drawing section 3.2.
[[nodiscard]] core::Result<DatumRock> datum_rock(
    std::span<const DatumCylinder> features,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// The secondary datum of a system after a primary plane: the one-sided cylinder square to it. Its
/// circle is that of the points projected along the normal, and the optimum is global.
/// @return The axis along the normal; as min_circumscribed_circle() or max_inscribed_circle().
/// Source: methods, drawing section 3.4.
[[nodiscard]] core::Result<DatumAxis> datum_axis_square_to(const Plane& primary,
                                                           const DatumCylinder& feature);

}  // namespace rondure::fit
