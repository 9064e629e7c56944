#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The tip centres that touch one ball in one combined pose, free of errors [mm].
using BallTouches = std::vector<Eigen::Vector3d>;

/// The standard uncertainty that the residuals of a fixture calibration will have by linear
/// propagation, whatever the fixture does.
struct ResidualPrediction {
  std::string why;  ///< Why there is none; the members below are then empty. Else empty.
  /// Of a coordinate of a ball centre: touches, the ball itself, the machine [mm].
  double center_u_mm = 0.0;
  std::size_t centers = 0;    ///< Ball centres of all combined poses.
  double rms_u_mm = 0.0;      ///< Of the rms residual: u of a centre over the root of their number.
  double largest_u_mm = 0.0;  ///< Of the largest residual, at most: u of a centre.
  std::string repeatability;  ///< The repeatability of a touch, and where it comes from.
};

/// Predicts it from the declared influences and the planned touches, before the first of them.
/// Repeatability of a touch: as `uncertainty.probe` declares it, else at most the value that the
/// form limit of the qualification just allows (P / 3.93), as predict() assumes it.
///
/// @param expected  Settings and features; holds no touches of the feature.
/// @param feature   Index of a feature of the type rotary_axes.
/// @param combined  The balls of all combined poses.
/// @return  kBadOption for another feature; `why` states what prevents it.
/// Source: docs/fixture-calibration.md, "Residual at combined poses".
[[nodiscard]] core::Result<ResidualPrediction> predict_residual(
    const record::RunRecord& expected, int feature, std::span<const BallTouches> combined);

}  // namespace rondure::evaluation
