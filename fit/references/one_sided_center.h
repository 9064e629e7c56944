#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/proof/certificate.h"
#include "fit/zone/contacts.h"
#include "fit/geometry/deviation_range.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// A circle (D = 2) or sphere (D = 3) that touches the points from one side.
template <int D>
struct OneSidedCenter {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the centre [mm].
  std::vector<Contact> contacts;  ///< Points on it that carry it; multipliers sum to 1.
  Certificate certificate;
  /// Where several inscribed circles are as large to kSameRadius and the deviation about them
  /// differs: from the least to the greatest.
  std::optional<DeviationRange> range;
};
using OneSidedCircle = OneSidedCenter<2>;
using OneSidedSphere = OneSidedCenter<3>;

/// Minimum circumscribed circle (MCCI), sphere: the smallest that holds all points. The problem is
/// convex, so its optimum is the only one: the certificate is global by the contacts alone.
///
/// @param points_mm  As ls_circle(), ls_sphere(): 3 (4) points, not on one line (plane) [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear (kRank). Same input, same bits.
/// Cost: as ZoneDescent. Sources: ISO 12181-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<OneSidedCircle> min_circumscribed_circle(
    std::span<const Eigen::Vector2d> points_mm);
[[nodiscard]] core::Result<OneSidedSphere> min_circumscribed_sphere(
    std::span<const Eigen::Vector3d> points_mm);

/// How far a maximum inscribed circle is proven.
struct InscribedOptions {
  /// Search all centres, for a reported value; false inside loops: the local proof only.
  bool global = true;
  GlobalSearchOptions search;
};

/// Maximum inscribed circle (MICI), sphere: the largest without a point inside, with its centre
/// inside the hull of the points.
///
/// The descent starts at the least-squares circle; then all centres inside the hull are searched
/// for a larger circle (global_search.h), which becomes the new start. Of a sphere the result is
/// the one next to the least-squares sphere, its certificate local.
///
/// @return also kReferenceAbsent where the points leave a gap through which it grows without bound.
/// Sources: ISO 12181-1; methods, cylindricity section 11.4, certificates section 2.
[[nodiscard]] core::Result<OneSidedCircle> max_inscribed_circle(
    std::span<const Eigen::Vector2d> points_mm, const InscribedOptions& options = {});
[[nodiscard]] core::Result<OneSidedSphere> max_inscribed_sphere(
    std::span<const Eigen::Vector3d> points_mm);

}  // namespace rondure::fit
