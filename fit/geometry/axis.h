#pragma once

#include <Eigen/Core>

namespace rondure::fit {

/// A straight line in space. Reported axes follow one convention, so that two programs print the
/// same line alike: `point_mm` is the point nearest to the mean of the data, `direction` a unit
/// vector whose largest component (in absolute value) is positive.
struct Axis {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// The same line in the convention above.
[[nodiscard]] Axis conventional(const Axis& axis, const Eigen::Vector3d& mean_mm);

/// Distance of a point from the line [mm].
[[nodiscard]] double distance_mm(const Axis& axis, const Eigen::Vector3d& point_mm);

/// Two unit vectors that make a right-handed frame with `direction` as z: column 0, column 1.
[[nodiscard]] Eigen::Matrix<double, 3, 2> across(const Eigen::Vector3d& direction);

}  // namespace rondure::fit
