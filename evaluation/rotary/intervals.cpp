#include <algorithm>
#include <optional>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "evaluation/rotary/result.h"
#include "evaluation/uncertainty/curve_trials.h"

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

/// The residual in every trial, and its change with the noise of the balls.
struct ResidualTrials {
  std::vector<double> rms_mm;
  std::vector<double> max_mm;
  CombinedField::Residual noise;
};

ResidualTrials residual_trials(const RotaryResult& result, const UncertaintyOptions& options) {
  const CombinedField field(result.combined, result.noise_mm);
  const int trials = std::max(2000, options.least_trials);
  ResidualTrials out;
  for (int t = 0; t < trials; ++t) {
    const CombinedField::Residual drawn = field.draw(options.seed, t);
    out.rms_mm.push_back(drawn.rms_mm);
    out.max_mm.push_back(drawn.max_mm);
  }
  out.noise = field.per_noise();
  return out;
}

UncertaintyStatus residual_interval(const RotaryResult& result, const record::Characteristic& asked,
                                    const ResidualTrials& trials,
                                    const UncertaintyOptions& options) {
  const fixture::Verification& v = result.calibration.verification;
  const bool rms = asked.form == record::Form::kFixtureResidualRms;
  TrialValues values;
  values.as_measured_mm = rms ? v.rms_mm : v.max_mm;
  values.values_mm = rms ? trials.rms_mm : trials.max_mm;
  auto stated = statement_of_trials(
      std::move(values), {{"ball-centre", rms ? trials.noise.rms_mm : trials.noise.max_mm}},
      declaration_of(result, true), options);
  return stated ? UncertaintyStatus::stated(*std::move(stated), options.coverage)
                : UncertaintyStatus::none(stated.error().said());
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
                        ? axis_error_interval(result, asked, declaration_of(result, false), options)
                        : UncertaintyStatus::none({}));
    } else if (result.combined.empty()) {
      out.push_back(UncertaintyStatus::none(core::phrase("no combined pose was measured")));
    } else {
      if (!residual) residual = residual_trials(result, options);
      out.push_back(residual_interval(result, asked, *residual, options));
    }
  }
  return out;
}

}  // namespace rondure::evaluation
