#include "reports/rotary_result.h"

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/words/language.h"

namespace rondure::reports {

using core::um;

std::vector<AxisFacts> axes_of(const RotaryFacts& facts) {
  return {{"alpha", translatable("Axis alpha (base-fixed, about x)"), &facts.alpha,
           facts.calibration.alpha.get()},
          {"beta", translatable("Axis beta (carried, about y)"), &facts.beta,
           facts.calibration.beta.get()}};
}

core::Result<AnalysisValue> RotaryResult::value_of(
    const record::Characteristic& characteristic) const {
  const fixture::Verification& v = facts_.calibration.verification;
  if (v.points == 0) return core::fail(core::Code::kNoPoints, "no combined pose was measured");
  AnalysisValue out;
  out.value_mm = characteristic.form == record::Form::kFixtureResidualRms ? v.rms_mm : v.max_mm;
  out.detail = fmt::format("{} um rms before compensation", um(v.before_rms_mm));
  return out;
}

ValueOperator RotaryResult::operator_of(const record::Characteristic& characteristic,
                                        const std::string& temperature) const {
  const fixture::Verification& v = facts_.calibration.verification;
  const bool rms = characteristic.form == record::Form::kFixtureResidualRms;
  return {ReferenceTerm(fmt::format("{} distance of balls in combined poses from where the "
                                    "calibration puts them",
                                    rms ? "rms" : "largest")),
          FilterTerm(filter_text()),
          SamplingTerm(fmt::format("{} ball centres in {} poses that the fit did not use", v.points,
                                   v.poses)),
          TipTerm("sphere fits with the certified radius"), TemperatureTerm(temperature)};
}

std::string RotaryResult::filter_text() const { return "unfiltered"; }

std::string RotaryResult::sampling_text() const {
  return fmt::format("{} balls, {} poses, {} touches", facts_.balls.size(), facts_.poses,
                     facts_.touches);
}

std::vector<SummaryLine> RotaryResult::summary() const {
  const fixture::Verification& v = facts_.calibration.verification;
  std::vector<SummaryLine> out = {
      {"fixture", fmt::format("{}, valid until {}", facts_.calibration.fixture_id,
                              facts_.calibration.expires_utc)},
      {"before", fmt::format("{} um rms, {} um at most", um(v.before_rms_mm), um(v.before_max_mm))},
      {"compensated", fmt::format("{} um rms, {} um at most; {} um rms expected", um(v.rms_mm),
                                  um(v.max_mm), um(v.expected_mm))}};
  return out;
}

std::string RotaryResult::calibration_file() const {
  return fixture::calibration_text(facts_.calibration);
}

}  // namespace rondure::reports
