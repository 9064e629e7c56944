#pragma once

#include <optional>

#include <Eigen/Core>

#include "evaluation/uncertainty/cloud.h"

namespace rondure::evaluation {

/// Layout of the points of a cloud, as far as it determines which form they resolve.
struct PointLayout {
  int layers = 1;
  /// Number in the layer with the fewest points, in one pass; for a helix, per turn.
  int points_per_layer = 0;
  bool layered = true;            ///< false: a helix, or scattered.
  bool regular = false;           ///< Even steps, all layers alike: the columns are orthogonal.
  std::optional<double> arc_rad;  ///< Angle covered, for points that do not close a turn.
  Eigen::VectorXd angle;          ///< Of every point; on an arc its fraction of the arc, times pi.
};

[[nodiscard]] PointLayout layout_of(const FormCloud& cloud, const Eigen::VectorXd& root_weights);

}  // namespace rondure::evaluation
