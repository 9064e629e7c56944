#pragma once

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

}  // namespace rondure::evaluation
