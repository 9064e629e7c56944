#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Coaxiality deviation (ISO 1101): diameter of the smallest cylinder about the datum axis that
/// holds the toleranced axis = 2 max |c_i - datum|.
/// @param median_mm  Points of the extracted median line: the circle centres of the sections, or
///                   the two ends of a fitted axis.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<double> coaxiality_mm(SpacePoints median_mm, const Axis& datum);

/// Circular run-out in every section.
struct RunOut {
  std::vector<double> sections_mm;  ///< Run-out of each section [mm].
  std::size_t greatest = 0;         ///< Index of the section with the greatest run-out.

  [[nodiscard]] double deviation_mm() const { return sections_mm[greatest]; }
};

/// Circular radial run-out (ISO 1101): in each section the greatest minus the least distance from
/// the datum axis. The deviation is that of the worst section.
/// @return kNoPoints (no section, or an empty one), kNotFinite; `what` names section and row.
[[nodiscard]] core::Result<RunOut> radial_run_out(
    std::span<const std::vector<Eigen::Vector3d>> sections_mm, const Axis& datum);

/// Total radial run-out (ISO 1101): gap between the two cylinders about the datum axis that enclose
/// the whole surface = greatest minus least distance of all points.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<double> total_radial_run_out_mm(SpacePoints points_mm,
                                                           const Axis& datum);

/// Total axial run-out (ISO 1101): distance between the two planes perpendicular to the datum axis
/// that enclose a face. For points at one radius it is the circular axial run-out there.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<double> axial_run_out_mm(SpacePoints points_mm, const Axis& datum);

}  // namespace rondure::fit
