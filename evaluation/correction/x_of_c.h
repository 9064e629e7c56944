#pragma once

#include <cstddef>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/uncertainty/statement.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// A correction of the command of X that takes the repeating part of f away: to be added to it at
/// the C positions 0, 1, ... 359 deg of the control, linear between them.
struct XCorrection {
  static constexpr std::size_t kRows = 360;

  std::vector<double> x_mm;  ///< Mean 0: the size of the pin stays as it is.
  std::vector<double> u_mm;  ///< Of f, and of its mean over the parts; of one part of f alone.
  std::size_t parts = 0;
  double before_mm = 0.0;  ///< Greatest peak to valley of t, as measured.
  double after_mm = 0.0;   ///< The same, were these parts ground with the correction.
  UncertaintyStatement gain;
};

/// The correction that a contour feature gives.
///
/// x(alpha) = -f(beta(alpha)) / cos(eta) with f the mean over the parts, without its mean. The
/// prediction grinds every part again, from its recorded errors and the rows as a control applies
/// them.
/// @return  The correction, or why none may leave the run: no result, a void curve, no interval, or
///          a gain (fall of the greatest peak to valley) whose interval does not lie above 0.
///          Same record, same bits; takes the trials of one value.
/// Source: methods, contour section 5; sister analyses, sections 10 and 11.
[[nodiscard]] core::Result<XCorrection> x_correction(const record::RunRecord& record,
                                                     const FeatureResult& result);

}  // namespace rondure::evaluation
