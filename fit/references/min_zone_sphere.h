#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"

namespace rondure::fit {

/// Two concentric spheres that hold all points between them with the least radial gap (MZSP).
struct MinZoneSphere {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer sphere that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;  ///< Local at best: no search of centres far from the least-squares one.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// Finds the minimum-zone sphere next to the least-squares sphere, and with it the sphericity
/// deviation.
///
/// @param points_mm  n >= 4, not all in one plane [mm].
/// @return as ls_sphere(). Same input, same bits. Cost: as ZoneDescent.
/// Source: methods, cylindricity section 9.3 with three unknowns.
[[nodiscard]] core::Result<MinZoneSphere> min_zone_sphere(SpacePoints points_mm);

}  // namespace rondure::fit
