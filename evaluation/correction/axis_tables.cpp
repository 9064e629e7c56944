#include "evaluation/correction/axis_tables.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/numbers.h"
#include "evaluation/analysis_result.h"
#include "evaluation/interval/internal/declared.h"

namespace rondure::evaluation {

core::Result<AxisTableGain> axis_table_gain(const record::RunRecord& record,
                                            const FeatureResult& result) {
  if (result.failure) return core::fail(*result.failure);
  if (!result.analysis) {
    return core::fail(core::Code::kMeaning, core::phrase("the feature has no result"));
  }
  const auto& facts = std::get<RotaryResult>(result.analysis->found);
  if (facts.withheld) return core::fail(core::Code::kMeaning, *facts.withheld);
  record::Characteristic residual;
  residual.form = record::Form::kFixtureResidualRms;
  const UncertaintyStatus status =
      intervals_of(facts, std::span(&residual, 1), uncertainty_options(record)).front();
  if (!status.result()) return core::fail(core::Code::kMeaning, status.why());
  const UncertaintyStatement& left = status.result()->sampled;
  AxisTableGain out;
  out.before_mm = facts.calibration.verification.before_rms_mm;
  out.after_mm = facts.calibration.verification.rms_mm;
  // Three coordinates of each ball have noise.
  const double noise2 = 3.0 * facts.noise_mm * facts.noise_mm;
  const double before_mm = std::sqrt(std::max(0.0, out.before_mm * out.before_mm - noise2));
  out.gain.estimate_mm = before_mm - left.estimate_mm;
  out.gain.low_mm = before_mm - left.high_mm;
  out.gain.high_mm = before_mm - left.low_mm;
  out.gain.standard_uncertainty_mm = left.standard_uncertainty_mm;
  if (out.gain.low_mm <= 0.0) {
    return core::fail(
        core::Code::kMeaning,
        core::phrase("the predicted gain is not significant: {} um, interval {} to {} um",
                     core::um(out.gain.estimate_mm), core::um(out.gain.low_mm),
                     core::um(out.gain.high_mm)));
  }
  return out;
}

}  // namespace rondure::evaluation
