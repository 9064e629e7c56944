#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
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

}  // namespace rondure::fit
