#include "evaluation/rotary/result.h"

#include "core/numbers.h"
#include "core/units.h"

namespace rondure::evaluation {

using core::um;

std::vector<AxisFacts> axes_of(const RotaryResult& facts) {
  return {{"alpha", &facts.alpha, facts.calibration.alpha.get()},
          {"beta", &facts.beta, facts.calibration.beta.get()}};
}

core::Result<AnalysisValue> value_of(const RotaryResult& facts,
                                     const record::Characteristic& characteristic) {
  const fixture::Verification& v = facts.calibration.verification;
  if (v.points == 0) return core::fail(core::Code::kNoPoints, "no combined pose was measured");
  AnalysisValue out;
  out.value_mm = characteristic.form == record::Form::kFixtureResidualRms ? v.rms_mm : v.max_mm;
  out.void_because = facts.withheld;
  out.detail = core::phrase("{} um rms before compensation", um(v.before_rms_mm));
  return out;
}

ValueOperator operator_of(const RotaryResult& facts, const record::Characteristic& characteristic,
                          const core::Phrase& temperature) {
  const fixture::Verification& v = facts.calibration.verification;
  const bool rms = characteristic.form == record::Form::kFixtureResidualRms;
  return {ReferenceTerm(core::phrase("{} distance of balls in combined poses from where the "
                                     "calibration puts them",
                                     rms ? core::phrase("rms") : core::phrase("largest"))),
          FilterTerm(filter_text(facts)),
          SamplingTerm(core::phrase("{} ball centres in {} poses that the fit did not use",
                                    v.points, v.poses)),
          TipTerm(core::phrase("sphere fits with the certified radius")),
          TemperatureTerm(temperature)};
}

core::Phrase filter_text(const RotaryResult& /*facts*/) { return core::phrase("unfiltered"); }

core::Phrase sampling_text(const RotaryResult& facts) {
  return core::phrase("{} balls, {} poses, {} touches", facts.balls.size(), facts.poses,
                      facts.touches);
}

}  // namespace rondure::evaluation
