#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/cone.h"
#include "fit/proof/certificate.h"
#include "fit/zone/ending.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// Two concentric circles (D = 2, MZCI) or spheres (D = 3, MZSP) that hold all points between them
/// with the least radial gap.
template <int D>
struct MinZoneCenter {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer circle or sphere that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  bool exact_fit = false;  ///< A circle of three distinct points: 0 by construction.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};
using MinZoneCircle = MinZoneCenter<2>;
using MinZoneSphere = MinZoneCenter<3>;

/// Finds the minimum-zone circle of one plane section.
///
/// Minimises  f(c) = max |p_i - c| - min |p_i - c|  by ZoneDescent from the algebraic circle. Then
/// searches all centres for a narrower zone: by search_centers(), or, for up to 40 points whose
/// zone is too wide for that, by enumeration of all bisector crossings. A better centre becomes the
/// new start, so the proof also serves as the global search.
///
/// @param points_mm  n >= 3 distinct points, any order [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints (fewer than 3 distinct), kCollinear. Same
///         input, same bits. If the search reaches its limit, or a strip holds the points as well,
///         the certificate is local and gives the reason. Cost: as ZoneDescent, and some 100 us of
///         proof.
/// Sources: ISO 12181-1 (definition); methods, cylindricity section 9, certificates section 2.
[[nodiscard]] core::Result<MinZoneCircle> min_zone_circle(PlanePoints points_mm,
                                                          const CenterProofOptions& options = {});

/// Finds the minimum-zone sphere next to the least-squares sphere, and with it the sphericity
/// deviation.
///
/// @param points_mm  n >= 4, not all in one plane [mm].
/// @return as ls_sphere(). The certificate is local at best: centres far from the least-squares one
///         are not searched. Same input, same bits. Cost: as ZoneDescent.
/// Source: methods, cylindricity section 9.3 with three unknowns.
[[nodiscard]] core::Result<MinZoneSphere> min_zone_sphere(SpacePoints points_mm);

/// Two coaxial cylinders that hold all points between them with the least radial gap (MZCY).
struct MinZoneCylinder {
  Axis axis;
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer cylinder that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  int boxes = 0;                           ///< Boxes of directions that the global search bounded.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< How the descent to the axis ended.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// Finds the minimum-zone cylinder: the least cylindricity deviation CYLt of the points (ISO 1101).
///
/// Descends (ZoneDescent) from the least-squares cylinder, to optima with six contacts and to those
/// with five, which curvature determines. Then searches the scopes of the options for a narrower
/// zone (search_axes()); a better axis becomes the new start, so the proof also serves as the
/// global search.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(); `ending` and `certificate` state how the search ended. Same input,
///         same bits. O(n) per pivot, some ten pivots per programme.
/// Sources: ISO 1101, ISO 12180-1; methods, cylindricity section 11, certificates section 1.
[[nodiscard]] core::Result<MinZoneCylinder> min_zone_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});

/// Two cones with one axis and one angle that hold all points between them with the least distance.
struct MinZoneCone {
  Cone cone;                   ///< Midway between the two.
  double width_mm = 0.0;       ///< Form deviation of the cone, normal to the surface [mm].
  std::vector<Contact> outer;  ///< Points on the cone away from the axis that carry the minimum.
  std::vector<Contact> inner;
  /// Local at best: next to the least-squares cone. None where one generatrix holds the zone: then
  /// other cones are as good to `gap_mm`.
  Certificate certificate;
  ZoneEnding ending = ZoneEnding::kLimit;  ///< How the descent ended.
};

/// Finds the minimum-zone cone next to the least-squares cone, with a free angle: up to seven
/// contacts (CoupledDescent with five unknowns).
///
/// @param points_mm, near_direction  As ls_cone().
/// @return as ls_cone(); `ending` and `certificate` state how the search ended. O(n) per step.
/// Source: methods, drawing section 9.2; certificates section 1 with one more row.
[[nodiscard]] core::Result<MinZoneCone> min_zone_cone(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// Two parallel planes that hold all points between them with the least distance (MZPL).
struct MinZonePlane {
  /// The upper plane, on the outer side of the material. It is also the one-sided (constrained
  /// minimax) plane: the plane outside the material whose greatest distance from a point is least.
  Plane outer;
  double width_mm = 0.0;        ///< Flatness deviation FLTt (ISO 1101) [mm].
  std::vector<Contact> top;     ///< Points on the outer plane that carry the minimum.
  std::vector<Contact> bottom;  ///< Points on the other plane.
  Certificate certificate;
  ZoneEnding ending = ZoneEnding::kLimit;  ///< kLimit: the normal did not come to rest.
};

/// Finds the minimum zone of a plane, and with it the one-sided plane.
///
/// In a frame at the present normal the points are heights over a plane, and their range after a
/// tilt with the slopes a, b is convex in them: a linear programme with three unknowns and the
/// width. It is solved again in the frame of the normal that it finds, until that rests. The
/// contacts are 3 + 1 or 2 + 2; multipliers give them one common point along the normal.
///
/// The certificate is global: the width along the normal of slopes (a, b) is the range divided by
/// sqrt(1 + a^2 + b^2). The range grows at least as the contacts push, and exceeds the width beyond
/// the slope 2 w / (m - w), where w is the width and m the least extent within the plane.
///
/// @param points_mm  n >= 3, as ls_plane(), extending farther within the plane than across [mm].
/// @param outward    As ls_plane().
/// @return as ls_plane(); kRank for points that extend no farther within the plane than across.
///         Same input, same bits. O(n) per pivot, some ten pivots per programme, two or three
///         programmes; O(n log n) for the certificate.
/// Sources: ISO 12781-1; M. E. Houle, G. T. Toussaint, IEEE Trans. PAMI 10 (1988) 761-765; methods,
/// drawing sections 3.1 and 9.1.
[[nodiscard]] core::Result<MinZonePlane> min_zone_plane(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& outward = std::nullopt);

/// The smallest cylinder about a line in space that holds all points.
struct MinZoneLine {
  Axis axis;
  double diameter_mm = 0.0;       ///< Straightness of the line (ISO 1101, zone with diameter sign).
  std::vector<Contact> contacts;  ///< Points that determine the cylinder; multipliers sum to 1.
  /// Of three points global, of more local at best: next to the least-squares line.
  Certificate certificate;
};

/// Finds the minimum-zone straightness of a line in space, or of a median line given by the centres
/// of its sections: the diameter of the minimum circumscribed cylinder next to the least-squares
/// line.
///
/// @param points_mm  n >= 2 different points, any order [mm].
/// @param proof      kNone: axis and diameter alone, without contacts and certificate.
/// @return as ls_line(). Same input, same bits. Cost: as ZoneDescent; of few points the proof costs
///         more than the search.
/// Sources: ISO 1101, ISO 12780-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<MinZoneLine> min_zone_line(SpacePoints points_mm,
                                                      Proof proof = Proof::kFull);

}  // namespace rondure::fit
