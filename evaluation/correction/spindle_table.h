#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// Part and synchronous motion at one work angle.
struct SpindleRow {
  double alpha_rad = 0.0;
  double theta_rad = 0.0;    ///< On the part, alpha + beta; in [0, 2 pi).
  double profile_mm = 0.0;   ///< r(theta), orders 2 and above as recovered.
  double motion_x_mm = 0.0;  ///< RX(alpha), about the centre of its polar plot.
  double motion_y_mm = 0.0;
  /// To be added to the command of X where a wheel opposite to P1 grinds the pin that was measured:
  /// -r(theta + pi) / cos eta, sin eta = crank / (wheel + pin) sin alpha. None: a shaft on centres.
  std::optional<double> command_mm;
};

/// What a control takes of three probes.
struct SpindleTable {
  static constexpr std::size_t kRows = 360;  ///< alpha 0, 1, ... 359 deg.

  std::vector<SpindleRow> rows;
  // Standard uncertainties by noise alone, the same at every angle.
  double u_profile_mm = 0.0;
  double u_motion_x_mm = 0.0;
  double u_motion_y_mm = 0.0;
  std::vector<int> missing;  ///< Orders that the probes do not show; they are 0 in the profile.
};

/// The table that a spindle feature gives.
///
/// @return  The table, or why none may leave the run: no result, a gate that voids, readings that
///          contradict the stated probes, too many samples and orders. Same result, same bits; some
///          transforms of a turn.
/// Source: methods, roundness A.7; machine cell, section 2.
[[nodiscard]] core::Result<SpindleTable> spindle_table(const FeatureResult& result);

}  // namespace rondure::evaluation
