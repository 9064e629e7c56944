#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/sizes/material.h"

namespace rondure::fit {

/// Global sizes of a cylinder, of a sphere, or of the circle of one section (ISO 14405-1):
/// diameters [mm].
///
/// GN of a shaft and GX of a bore are those of the surface itself for any tip radius; the others
/// are those of the surface as the tip feels it, which bridges valleys narrower than the tip.
struct GlobalSizes {
  double gg_mm = 0.0;                ///< Least squares.
  double gn_mm = 0.0;                ///< Minimum circumscribed.
  core::Result<double> gx_mm = 0.0;  ///< Maximum inscribed, or why there is none (arcs).
  double gc_mm = 0.0;                ///< Minimax: mean diameter of the minimum zone.
};

/// Computes the global sizes of a cylinder from tip centres. GN, GX and GC are those next to the
/// least-squares axis.
/// @param points_mm       n >= 5 points in at least two sections [mm].
/// @param near_direction  As ls_cylinder().
/// @return as ls_cylinder(), kBadOption (tip radius), kNotConverged; kReferenceAbsent where the
///         points do not surround the axis. Cost: three fits without proof.
/// Source: methods, drawing section 2.2.
[[nodiscard]] core::Result<GlobalSizes> global_sizes(
    SpacePoints points_mm, const Material& material,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// Computes the sizes of the circle of one section: ACS and SCS.
/// @return as ls_circle(), kBadOption (tip radius), kNotConverged, kReferenceAbsent.
/// Source: methods, drawing section 2.5.
[[nodiscard]] core::Result<GlobalSizes> global_sizes(PlanePoints points_mm,
                                                     const Material& material);

/// Computes the sizes of a sphere. GX is absent where a cap is open, through which the inscribed
/// sphere would grow.
/// @return as ls_sphere(), kBadOption (tip radius), kNotConverged.
/// Source: methods, drawing section 9.3.
[[nodiscard]] core::Result<GlobalSizes> global_sizes_of_sphere(SpacePoints points_mm,
                                                               const Material& material);

}  // namespace rondure::fit
