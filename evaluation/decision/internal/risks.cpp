#include "evaluation/decision/internal/risks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondure::evaluation {
namespace {

Limits moved(Limits limits, double by_mm) {
  if (limits.lower_mm) *limits.lower_mm += by_mm;
  if (limits.upper_mm) *limits.upper_mm += by_mm;
  return limits;
}

/// The compared values that apply_rule() accepts, and those that it does not reject, where reading
/// and interval move along with the compared value: the limits of the rule, and what a reading
/// beyond a limit, a bound that proves nothing and a lack of capability take away from them.
struct Decided {
  Limits accepted;
  Limits not_rejected;
};

Decided decided(const DecisionRule& rule, const KnownValue& value, const RuleOutcome& outcome,
                const Limits& limits) {
  const UncertaintyStatement& known = *value.statement;
  const double compared_mm = outcome.compared_mm;
  Decided out{outcome.acceptance, outcome.rejection};
  auto& [accepted, not_rejected] = out;
  const auto accept_only = [&](const Limits& zone) {
    if (zone.lower_mm) accepted.lower_mm = std::max(*accepted.lower_mm, *zone.lower_mm);
    if (zone.upper_mm) accepted.upper_mm = std::min(*accepted.upper_mm, *zone.upper_mm);
  };
  const auto accept_none = [&] { accepted.upper_mm = -std::numeric_limits<double>::infinity(); };
  if (!rule.judge_corrected) accept_only(moved(limits, compared_mm - value.measured_mm));
  const bool incapable = limits.lower_mm && limits.upper_mm &&
                         known.high_mm - known.low_mm > *limits.upper_mm - *limits.lower_mm;
  if (known.at_most) accept_only({{}, moved(limits, compared_mm - known.high_mm).upper_mm});
  if (incapable || (known.at_most && limits.lower_mm.value_or(0.0) > 0.0)) accept_none();
  if (incapable || known.at_most) {  // rejected is only what lies beyond a limit as a whole
    const auto lower_mm = moved(limits, compared_mm - known.high_mm).lower_mm;
    const auto upper_mm = moved(limits, compared_mm - known.low_mm).upper_mm;
    if (lower_mm) not_rejected.lower_mm = std::min(*not_rejected.lower_mm, *lower_mm);
    if (upper_mm) not_rejected.upper_mm = std::max(*not_rejected.upper_mm, *upper_mm);
  }
  return out;
}

}  // namespace

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
  const auto [accepted, not_rejected] = decided(rule, value, outcome, limits);
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
      out.false_acceptance_1 += weight * share_within(accepted, y_mm);
    } else {
      out.false_rejection_1 += weight * (1.0 - share_within(not_rejected, y_mm));
    }
  }
  out.false_acceptance_1 /= sum;
  out.false_rejection_1 /= sum;
  return out;
}

}  // namespace rondure::evaluation
