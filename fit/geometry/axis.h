#pragma once

#include <Eigen/Core>

namespace rondure::fit {

/// A straight line in space. Reported axes follow one convention, so that equal lines are printed
/// equally: `point_mm` is the point of the line nearest to the mean of the data, `direction` a unit
/// vector whose largest component (in absolute value) is positive.
struct Axis {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// Returns the same line in the convention of Axis.
/// @param mean_mm  Mean of the data [mm].
[[nodiscard]] Axis conventional(const Axis& axis, const Eigen::Vector3d& mean_mm);

/// Distance of a point from the line [mm].
[[nodiscard]] double distance_mm(const Axis& axis, const Eigen::Vector3d& point_mm);

/// Returns two unit vectors, in columns 0 and 1, that form a right-handed frame with `direction`
/// as z.
/// @pre `direction` is a unit vector.
[[nodiscard]] Eigen::Matrix<double, 3, 2> across(const Eigen::Vector3d& direction);

}  // namespace rondure::fit
