#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/ending.h"

namespace rondure::fit {

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

}  // namespace rondure::fit
