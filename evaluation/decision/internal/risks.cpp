#include "evaluation/decision/internal/risks.h"

#include <algorithm>
#include <cmath>

namespace rondure::evaluation {

double Prior::density(double value_mm) const {
  if (!(value_mm >= 0.0)) return 0.0;
  const double relative = standard_deviation_mm / mean_mm;
  if (kind == Kind::kNormal) {
    const double z = (value_mm - mean_mm) / standard_deviation_mm;
    return std::exp(-0.5 * z * z);
  }
  const double shape = 1.0 / (relative * relative);
  const double x = value_mm / mean_mm;  // about 1, so that no power overflows
  const double power = shape > 1.0 ? (shape - 1.0) * std::log(x) : 0.0;
  return std::exp(power - shape * (x - 1.0));
}

std::optional<double> conformance(const UncertaintyStatement& known,
                                  const std::optional<Prior>& prior, double shift_mm,
                                  const Limits& limits) {
  const auto& values = known.values_mm;
  if (values.empty()) return std::nullopt;
  const auto first_within =
      limits.lower_mm ? std::lower_bound(values.begin(), values.end(), *limits.lower_mm - shift_mm)
                      : values.begin();
  const auto first_above =
      limits.upper_mm ? std::upper_bound(first_within, values.end(), *limits.upper_mm - shift_mm)
                      : values.end();
  if (!prior) {
    return static_cast<double>(first_above - first_within) / static_cast<double>(values.size());
  }
  constexpr double kLeastWeighted = 50.0;  // fewer values give no meaningful probability
  double sum = 0.0;
  double squares = 0.0;
  double within = 0.0;
  for (auto value = values.begin(); value != values.end(); ++value) {
    const double weight = prior->density(*value + shift_mm);
    sum += weight;
    squares += weight * weight;
    if (value >= first_within && value < first_above) within += weight;
  }
  if (!(sum > 0.0) || sum * sum < kLeastWeighted * squares) return std::nullopt;
  return within / sum;
}

std::optional<GlobalRisks> global_risks(const DecisionRule& rule, const KnownValue& value,
                                        const RuleOutcome& outcome, const Limits& limits) {
  if (!rule.needs_interval() || !rule.prior || !value.statement ||
      value.statement->values_mm.empty()) {
    return std::nullopt;
  }
  const Prior& prior = *rule.prior;
  const auto& values = value.statement->values_mm;
  const double count = static_cast<double>(values.size());
  // The compared value of a part with true value y is y + e, where e = compared - value of a trial.
  const auto share_within = [&](const Limits& zone, double y_mm) {
    const double sum_mm = outcome.compared_mm + y_mm;
    const auto first = zone.upper_mm
                           ? std::lower_bound(values.begin(), values.end(), sum_mm - *zone.upper_mm)
                           : values.begin();
    const auto last = zone.lower_mm ? std::upper_bound(first, values.end(), sum_mm - *zone.lower_mm)
                                    : values.end();
    return static_cast<double>(last - first) / count;
  };
  constexpr int kCells = 4000;
  const double end_mm = prior.mean_mm + 12.0 * prior.standard_deviation_mm;
  GlobalRisks out;
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double y_mm = end_mm * (i + 0.5) / kCells;
    const double weight = prior.density(y_mm);
    sum += weight;
    if (!limits.hold(y_mm)) {
      out.false_acceptance_1 += weight * share_within(outcome.acceptance, y_mm);
    } else {
      out.false_rejection_1 += weight * (1.0 - share_within(outcome.rejection, y_mm));
    }
  }
  out.false_acceptance_1 /= sum;
  out.false_rejection_1 /= sum;
  return out;
}

}  // namespace rondure::evaluation
