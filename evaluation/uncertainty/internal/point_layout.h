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
};

/// The layout, and where on its turn or arc every point lies.
struct LaidOut {
  PointLayout layout;
  Eigen::VectorXd angle;  ///< Angle; on an arc its fraction of the arc, times pi.
};

/// @param alike  Whether all points have one weight.
[[nodiscard]] LaidOut laid_out(const FormCloud& cloud, bool alike);

}  // namespace rondure::evaluation
