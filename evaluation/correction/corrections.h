#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/uncertainty/statement.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// What the tables of the axes of a fixture take away at poses that were not used to find them.
struct AxisTableGain {
  double before_mm = 0.0;  ///< Rms against the nominal axes, as measured.
  double after_mm = 0.0;   ///< The same with the tables.
  UncertaintyStatement gain;
};

/// The gain of the tables of a calibrated fixture: rms at the combined poses without them, less
/// the noise of the balls, minus the rms with them, of which the interval is.
/// @return  Or why no table may leave the run: no result, a calibration that is withheld, no
///          interval, or a gain whose interval does not lie above 0.
[[nodiscard]] core::Result<AxisTableGain> axis_table_gain(const record::RunRecord& record,
                                                          const FeatureResult& result);

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

struct WheelResult;  // wheel/result.h

/// The wheel whose path over its surface may reach a machine: `evaluation.path` is there.
///
/// @return  Owned by `result`; or why no path may leave the run: no result, a gate that voids, no
///          surface, a path that is refused, a radius that proves nothing, a characteristic that is
///          void or does not conform.
[[nodiscard]] core::Result<const WheelResult*> wheel_for_path(const FeatureResult& result);

/// A correction of the command of X that takes the repeating part of f away: to be added to it at
/// equal steps of C as the control counts it, from 0, linear between them.
struct XCorrection {
  std::vector<double> x_mm;  ///< Mean 0: the size of the pin stays as it is.
  /// Of f, of its mean over the parts (of one part of f alone), and of the rounding of the row.
  std::vector<double> u_mm;
  std::size_t parts = 0;
  double before_mm = 0.0;  ///< Greatest peak to valley of t, as measured.
  double after_mm = 0.0;   ///< The same, were these parts ground with the correction.
  UncertaintyStatement gain;
};

/// The correction that a contour feature gives.
///
/// x(alpha) = -f(beta(alpha)) / cos(eta) with f the mean over the parts, without its mean, in
/// the steps and with the orders and the resolution that `contour.correction` asks for. The
/// prediction grinds every part again, from its recorded errors and the rows as a control applies
/// them.
/// @return  The correction, or why none may leave the run: no result, a void curve, no interval,
///          rows beyond the limit of the plan, or a gain (fall of the greatest peak to valley)
///          whose interval does not lie above 0. Same record, same bits; takes the trials of one
///          value.
/// Source: methods, contour section 5; sister analyses, sections 10 and 11.
[[nodiscard]] core::Result<XCorrection> x_correction(const record::RunRecord& record,
                                                     const FeatureResult& result);

}  // namespace rondure::evaluation
