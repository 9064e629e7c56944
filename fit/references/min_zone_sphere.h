#pragma once

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/references/min_zone_circle.h"

namespace rondure::fit {

/// Finds the minimum-zone sphere next to the least-squares sphere, and with it the sphericity
/// deviation.
///
/// @param points_mm  n >= 4, not all in one plane [mm].
/// @return as ls_sphere(). The certificate is local at best: centres far from the least-squares one
///         are not searched. Same input, same bits. Cost: as ZoneDescent.
/// Source: methods, cylindricity section 9.3 with three unknowns.
[[nodiscard]] core::Result<MinZoneSphere> min_zone_sphere(SpacePoints points_mm);

}  // namespace rondure::fit
