#include <algorithm>
#include <optional>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "evaluation/rotary/result.h"

namespace rondure::evaluation {
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
