#include "evaluation/rotary/result.h"

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/gates.h"

namespace rondure::evaluation {

using core::um;

std::vector<AxisFacts> axes_of(const RotaryResult& facts) {
  return {{"alpha", &facts.alpha, facts.calibration.alpha.get()},
          {"beta", &facts.beta, facts.calibration.beta.get()}};
}

namespace {

/// Below, an error of a ball is not seen by the others.
constexpr double kLeastRedundancy = 0.1;

core::Result<AnalysisValue> axis_error(const RotaryResult& facts,
                                       const record::Characteristic& characteristic) {
  const record::Indication& asked = characteristic.indication;
  if (!asked.axis || !asked.error) {
    return core::fail(core::Code::kMissingKey, "an axis-error needs axis and error");
  }
  const AxisCurve curve = axis_curve(facts, characteristic);
  if (curve.found_mm.empty()) {
    return core::fail(core::Code::kNoPoints,
                      core::phrase("no station was measured beside the zero pose"));
  }
  const AxisExtreme extreme = axis_extreme(curve.found_mm, middle_of(characteristic));
  AnalysisValue out;
  out.value_mm = axis_value_mm(characteristic, extreme);
  out.detail = core::phrase("at {:.1f} deg", core::degrees(curve.angle_rad[extreme.station]));
  out.void_because = facts.withheld;
  if (const double seen = curve.redundancy[extreme.station];
      !out.void_because && seen < kLeastRedundancy) {
    out.void_because = core::phrase(
        "one station decides, and an error of one of its balls is not seen by the others "
        "(redundancy {:.2f}, at least {:g} is needed): use 4 balls or more, spread out",
        seen, kLeastRedundancy);
  }
  return out;
}

}  // namespace

core::Result<AnalysisValue> value_of(const RotaryResult& facts,
                                     const record::Characteristic& characteristic) {
  if (characteristic.form == record::Form::kAxisError) return axis_error(facts, characteristic);
  const fixture::Verification& v = facts.calibration.verification;
  if (v.points == 0) return core::fail(core::Code::kNoPoints, "no combined pose was measured");
  AnalysisValue out;
  out.value_mm = characteristic.form == record::Form::kFixtureResidualRms ? v.rms_mm : v.max_mm;
  out.void_because = facts.withheld;
  if (auto why = residual_not_shown(facts); why && !out.void_because) {
    out.void_because = *std::move(why);
    out.lower_bound = true;
  }
  out.detail = core::phrase("{} um rms before compensation", um(v.before_rms_mm));
  return out;
}

ValueOperator operator_of(const RotaryResult& facts, const record::Characteristic& characteristic,
                          const core::Phrase& temperature) {
  if (characteristic.form == record::Form::kAxisError) {
    return {ReferenceTerm(core::phrase("largest over the stations, from the zero pose")),
            FilterTerm(filter_text(facts)), SamplingTerm(sampling_text(facts)),
            TipTerm(core::phrase("sphere fits with the certified radius")),
            TemperatureTerm(temperature)};
  }
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
