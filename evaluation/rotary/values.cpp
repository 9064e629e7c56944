#include "evaluation/rotary/result.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/combined_field.h"
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

namespace {

InfluenceStatement statement_of(const char* name, const record::Influence& influence, double unit,
                                const core::Phrase& covered, const core::Phrase& missing) {
  if (!influence) return {name, false, missing};
  return {name, true,
          core::phrase("{}: u = {:.3g}", covered, influence->standard_uncertainty() * unit)};
}

std::vector<InfluenceStatement> declaration_of(const RotaryResult& facts, bool of_poses) {
  const record::RotaryInfluencesTask& said = *facts.declared;
  return {{"ball-centre", true,
           core::phrase("ball centre, scatter of the touches included: u = {} um",
                        core::um(facts.noise_mm))},
          {kTipRadius, true,
           of_poses ? core::phrase("radius of the tip: both axes together cancel it")
                    : core::phrase("radius of the tip, by the scatter of its qualification: u = {} "
                                   "um",
                                   core::um(facts.tip_u_mm))},
          statement_of("axis-repeatability", said.repeat_urad, 1.0,
                       core::phrase("repeatability of an axis [urad]"),
                       core::phrase("repeatability of an axis: not declared (repeat_urad)")),
          statement_of("angle-reading", said.reading_urad, 1.0,
                       core::phrase("reading of an angle [urad]"),
                       core::phrase("reading of an angle: not declared (reading_urad)")),
          {"other-poses", false,
           of_poses ? core::phrase("errors in poses that were not measured: not covered, the value "
                                   "is that of these poses")
                    : core::phrase("errors between the stations: not covered, the value is that of "
                                   "the stations")},
          {"fixture-temperature", false,
           core::phrase(
               "a temperature in use that differs from that of the calibration: not covered")}};
}

}  // namespace

std::vector<UncertaintyStatus> intervals_of(const RotaryResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  const auto none = [&](const core::Phrase& why) {
    return std::vector<UncertaintyStatus>(characteristics.size(), UncertaintyStatus::none(why));
  };
  if (!result.declared) {
    return none(
        core::phrase("no influence is declared: state `uncertainty` of `rotary_axes`, with "
                     "`ball_um`, `repeat_urad` and `reading_urad`"));
  }
  std::vector<UncertaintyStatus> out;
  std::optional<ResidualTrials> residual;
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form == record::Form::kAxisError) {
      out.push_back(asked.indication.axis && asked.indication.error
                        ? axis_error_interval(axis_curve(result, asked), asked,
                                              declaration_of(result, false), options)
                        : UncertaintyStatus::none({}));
    } else if (result.combined.empty()) {
      out.push_back(UncertaintyStatus::none(core::phrase("no combined pose was measured")));
    } else {
      const fixture::Verification& v = result.calibration.verification;
      if (!residual) residual = residual_trials(result.combined, result.noise_mm, options);
      const bool rms = asked.form == record::Form::kFixtureResidualRms;
      out.push_back(residual_interval(rms ? v.rms_mm : v.max_mm, rms, *residual,
                                      declaration_of(result, true), options));
    }
  }
  return out;
}

}  // namespace rondure::evaluation
