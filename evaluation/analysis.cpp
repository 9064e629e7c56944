#include "evaluation/analysis.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/analysis_result.h"
#include "evaluation/internal/conformance.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/chain.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/gates.h"
#include "evaluation/results/measured_cloud.h"

namespace rondure::evaluation {
namespace {

/// The limit that stands when there is no value: of a mask its first line.
std::optional<double> nominal_limit(const record::Characteristic& asked) {
  if (!asked.harmonic_limits.empty()) return asked.harmonic_limits.front().amplitude_mm;
  return asked.tolerance_mm;
}

/// A value, or under a rule that asks for one the end of its interval, conforms only where it does
/// with what was not seen as well.
void leave_room_for_unseen(double unseen_mm, const UncertaintyStatement* interval,
                           CharacteristicResult& out) {
  const bool conforms = out.verdict == Verdict::kConforms && out.characteristic.tolerance_mm;
  if (!conforms || unseen_mm == 0.0) return;
  const double value_mm = interval != nullptr ? interval->high_mm : out.value->value_mm();
  if (value_mm + unseen_mm <= *out.characteristic.tolerance_mm) return;
  overrule(out, Verdict::kUndecided);
  out.reason = core::phrase(
      "up to {} um were not seen, and no interval holds them: with them {} um may be {} um, above "
      "the limit; measure more points, or recover higher harmonics",
      core::um(unseen_mm), core::um(value_mm), core::um(value_mm + unseen_mm));
}

void judge(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
           const FeatureResult& result, const UncertaintyStatus& interval,
           CharacteristicResult& out) {
  record::Characteristic& asked = out.characteristic;
  asked.tolerance_mm = nominal_limit(asked);
  out.verdict = Verdict::kVoid;
  if (!result.analysis) {
    out.reason = result.failure ? result.failure->said() : core::phrase("there is no result");
    return;
  }
  const auto chain = chain_fault(result);
  const auto value = value_of(*result.analysis, asked);
  if (!value) {
    out.reason = chain.value_or(value.error().said());
    return;
  }
  if (!std::isfinite(value->value_mm)) {
    out.reason = core::phrase("the computation gave no finite number");
    return;
  }
  // No analysis has an interval of the whole surface: a rule that asks for one is not served with
  // that of the points.
  const bool asks = rule && rule->needs_interval();
  out.value.emplace(symbol_of(asked), value->value_mm,
                    operator_of(*result.analysis, asked, temperature_words(result)), interval,
                    asks ? rule->measurand : Measurand::kSampledPoints, unit_of(asked),
                    Quoting{.as_read = rule && !asks,
                            .at_least = value->lower_bound && value->void_because.has_value()});
  if (value->limit_mm) asked.tolerance_mm = value->limit_mm;
  const bool proves =
      value->lower_bound && asked.tolerance_mm && value->value_mm > *asked.tolerance_mm;
  if (chain) {  // before all else: also a bound would rest on what the other feature gave
    out.reason = *chain;
  } else if (value->void_because && !proves) {
    out.reason = *value->void_because;
  } else if (!result.complete) {
    out.reason = core::phrase("the run did not finish");
  } else if (auto fault = temperature_fault(record, result)) {
    out.reason = *std::move(fault);
  } else if (auto stale = age_fault(record, result.feature)) {
    out.reason = *std::move(stale);
  } else {
    apply(rule, out);
    if (value->void_because && out.verdict != Verdict::kDoesNotConform) {
      // The value as read is above the limit, but its interval is not: a bound proves no more.
      overrule(out, Verdict::kVoid);
      out.reason = *value->void_because;
    }
    leave_room_for_unseen(value->unseen_mm, asks ? interval.about(rule->measurand) : nullptr, out);
    if (!value->detail.empty()) out.reason = core::phrase("{} ({})", out.reason, value->detail);
  }
}

/// The result of an analysis, or why there is none.
template <class Found>
void keep(core::Result<Found> found, FeatureResult& result) {
  if (found) {
    result.analysis = std::make_shared<AnalysisResult>(*std::move(found));
  } else {
    result.failure = std::move(found.error());
  }
}

}  // namespace

core::Result<AnalysisValue> value_of(const AnalysisResult& result,
                                     const record::Characteristic& characteristic) {
  return std::visit([&](const auto& found) { return value_of(found, characteristic); },
                    result.found);
}

ValueOperator operator_of(const AnalysisResult& result,
                          const record::Characteristic& characteristic,
                          const core::Phrase& temperature) {
  return std::visit(
      [&](const auto& found) { return operator_of(found, characteristic, temperature); },
      result.found);
}

std::vector<UncertaintyStatus> intervals_of(const AnalysisResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  return std::visit(
      [&](const auto& found) { return intervals_of(found, characteristics, options); },
      result.found);
}

core::Phrase filter_text(const AnalysisResult& result) {
  return std::visit([](const auto& found) { return filter_text(found); }, result.found);
}

core::Phrase sampling_text(const AnalysisResult& result) {
  return std::visit([](const auto& found) { return sampling_text(found); }, result.found);
}

namespace {

/// The wheels among the features before one, for those that take values of them.
EarlierWheel wheel_among(std::span<const FeatureResult> earlier) {
  return [earlier](const std::string& id) -> core::Result<const WheelResult*> {
    TRY(const auto producer, producer_of(id, earlier));
    const auto* const wheel = std::get_if<WheelResult>(&producer->analysis->found);
    if (wheel != nullptr) return wheel;
    return core::fail(core::Code::kMeaning,
                      core::phrase("it takes a value of feature {}, which is no wheel", id));
  };
}

/// The radii of these wheels.
RadiusOf radius_among(std::span<const FeatureResult> earlier) {
  return [wheels = wheel_among(earlier)](const std::string& id) -> core::Result<MeasuredRadius> {
    TRY(const auto wheel, wheels(id));
    return measured_radius(*wheel, id);
  };
}

/// What the heads among these features found.
HeadOf head_among(std::span<const FeatureResult> earlier) {
  return [earlier](const std::string& id) -> core::Result<HeadGain> {
    TRY(const auto producer, producer_of(id, earlier));
    const auto* const found = std::get_if<FiveAxisResult>(&producer->analysis->found);
    if (found != nullptr) return HeadGain{id, found->study.before, found->study.left.rms_mm};
    return core::fail(core::Code::kMeaning,
                      core::phrase("the table is that of feature {}, which is no head", id));
  };
}

/// What the pins among these features had.
ContourOf pins_among(std::span<const FeatureResult> earlier) {
  return [earlier](const std::string& id) -> core::Result<ContourGain> {
    TRY(const auto producer, producer_of(id, earlier));
    const auto* const found = std::get_if<ContourResult>(&producer->analysis->found);
    if (found != nullptr) {
      return ContourGain{id, fit::peak_to_valley(fit::mean_following(found->study))};
    }
    return core::fail(
        core::Code::kMeaning,
        core::phrase("the correction is that of feature {}, which is no contour", id));
  };
}

/// Evaluates the series of a feature, or says why they cannot be.
void evaluate_series(const record::RunRecord& record, int index,
                     std::span<const FeatureResult> earlier, FeatureResult& result) {
  const bool recorded =
      std::any_of(record.series.begin(), record.series.end(), [&](const record::Series& series) {
        return series.feature == index && series.role == record::Series::Role::kData;
      });
  // A contour names one series per part and looks for each itself.
  const bool named =
      result.feature.shape == record::Shape::kContour || record.data_of(index, "data") != nullptr;
  if (!recorded || !named) {
    result.failure =
        core::Error{core::Code::kNoPoints, "the run ended before its data were kept", {}};
    return;
  }
  switch (result.feature.shape) {
    case record::Shape::kSpindle:
      keep(evaluate_spindle(record, index, radius_among(earlier), result), result);
      break;
    case record::Shape::kWheel:
      keep(evaluate_wheel(record, index, wheel_among(earlier), result), result);
      break;
    case record::Shape::kContour:
      keep(evaluate_contour(record, index, radius_among(earlier), pins_among(earlier), result),
           result);
      break;
    case record::Shape::kFiveAxis:
      keep(evaluate_five_axis(record, index, head_among(earlier), result), result);
      break;
    default:
      result.failure = core::Error{
          core::Code::kMeaning,
          fmt::format("this version does not evaluate a {}", record::name_of(result.feature.shape)),
          {}};
  }
}

}  // namespace

FeatureResult evaluate_analysis(const record::RunRecord& record, int index,
                                const std::optional<fit::ProbeTip>& probe,
                                std::span<const FeatureResult> earlier) {
  FeatureResult result;
  result.feature = record.features[static_cast<std::size_t>(index)];
  result.complete = is_complete(record, static_cast<std::size_t>(index));
  if (result.feature.shape == record::Shape::kRotaryAxes) {  // its data are touches
    if (probe) result.tip_radius_mm = probe->radius_mm;
    keep(evaluate_rotary(record, index, probe, result), result);
  } else {
    result.temperatures = temperatures_of_series(record, index);
    evaluate_series(record, index, earlier, result);
  }
  std::vector<Gate> gates = temperature_gates(record, result);
  if (auto age = age_gate(record, result.feature)) gates.push_back(*std::move(age));
  result.gates.insert(result.gates.begin(), gates.begin(), gates.end());
  return result;
}

void decide_analysis(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
                     FeatureResult& result, bool with_intervals) {
  const std::vector<record::Characteristic>& asked = result.feature.characteristics;
  std::vector<UncertaintyStatus> intervals(asked.size(), UncertaintyStatus::none({}));
  if (result.analysis && with_intervals) {
    intervals = intervals_of(*result.analysis, asked, uncertainty_options(record));
  }
  for (std::size_t c = 0; c < asked.size(); ++c) {
    CharacteristicResult out;
    out.characteristic = asked[c];
    const auto& own = asked[c].indication.decision_rule;
    judge(record, own ? core::Result<DecisionRule>(rule_of(*own)) : rule, result, intervals[c],
          out);
    result.characteristics.push_back(std::move(out));
  }
}

}  // namespace rondure::evaluation
