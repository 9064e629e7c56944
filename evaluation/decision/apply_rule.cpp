#include "evaluation/decision/decision.h"

#include <algorithm>
#include <cmath>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/decision/internal/risks.h"

namespace rondure::evaluation {
namespace {

using core::fixed;
using core::micrometres;

tl::unexpected<core::Error> no_verdict(core::Phrase why) {
  return core::fail(core::Code::kMeaning, std::move(why));
}

/// Acceptance and rejection limits of a rule, on the scale of the compared value.
struct Limits {
  double compared_mm = 0.0;
  double acceptance_mm = 0.0;
  double rejection_mm = 0.0;
};

Verdict verdict_of(const Limits& limits) {
  if (limits.compared_mm <= limits.acceptance_mm) return Verdict::kConforms;
  return limits.compared_mm > limits.rejection_mm ? Verdict::kDoesNotConform : Verdict::kUndecided;
}

/// The greatest estimate at which the probability of conformance is at least `least`, found by
/// shifting the distribution.
double limit_at(const UncertaintyStatement& known, const std::optional<Prior>& prior,
                double tolerance_mm, double least) {
  const double span_mm = known.values_mm.back() - known.values_mm.front() + tolerance_mm;
  double low_mm = tolerance_mm - 2.0 * span_mm;  // surely conforms
  double high_mm = tolerance_mm + 2.0 * span_mm;
  for (int i = 0; i < 40; ++i) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    const auto p = conformance(known, prior, middle_mm - known.estimate_mm, tolerance_mm);
    // Where the prior gives the distribution no weight, the middle of the distribution decides on
    // which side of the limit the part lies.
    const bool enough = p ? *p >= least : middle_mm < tolerance_mm;
    (enough ? low_mm : high_mm) = middle_mm;
  }
  return low_mm;
}

Limits limits_of(const DecisionRule& rule, const KnownValue& value, double tolerance_mm) {
  using Kind = DecisionRule::Kind;
  Limits out{value.measured_mm, tolerance_mm, tolerance_mm};
  if (!rule.needs_interval()) return out;
  const UncertaintyStatement& known = *value.statement;
  out.compared_mm = known.estimate_mm;
  if (rule.kind == Kind::kIso14253) {
    out.acceptance_mm -= rule.guard_factor * (known.high_mm - known.estimate_mm);
    out.rejection_mm += rule.guard_factor * (known.estimate_mm - known.low_mm);
  } else if (rule.kind == Kind::kGuardBand) {
    out.acceptance_mm -= rule.acceptance_guard_1 * known.expanded_mm();
    out.rejection_mm += rule.rejection_guard_1 * known.expanded_mm();
  } else if (rule.kind == Kind::kJcgm106) {
    out.acceptance_mm = limit_at(known, rule.prior, tolerance_mm, 1.0 - rule.consumer_risk_1);
    out.rejection_mm = limit_at(known, rule.prior, tolerance_mm, rule.producer_risk_1);
  }
  return out;
}

/// A length in um with one digit more than the uncertainty warrants.
std::string in_digits(const KnownValue& value, double length_mm) {
  const int decimals = value.statement ? decimals_for(value.statement->expanded_mm()) + 1 : 3;
  return fixed(micrometres(length_mm), decimals);
}

/// "7.958 um is within the tolerance of 12 um by 4.042 um".
core::Phrase simple_sentence(const core::Phrase& text, const KnownValue& value,
                             const Limits& limits, double tolerance_mm) {
  const bool within = limits.compared_mm <= tolerance_mm;
  return core::phrase("{} is {} the tolerance of {:g} um by {} um", text,
                      within ? core::phrase("within") : core::phrase("above"),
                      micrometres(tolerance_mm),
                      in_digits(value, std::abs(tolerance_mm - limits.compared_mm)));
}

core::Phrase corrected_value(const KnownValue& value, const Limits& limits) {
  return core::phrase("the corrected value {} um", in_digits(value, limits.compared_mm));
}

core::Phrase guarded_sentence(const KnownValue& known, const Limits& limits, double tolerance_mm,
                              Verdict verdict) {
  const core::Phrase value = corrected_value(known, limits);
  const std::string acceptance = in_digits(known, limits.acceptance_mm);
  const std::string rejection = in_digits(known, limits.rejection_mm);
  if (verdict == Verdict::kConforms) {
    return core::phrase(
        "{} is within the acceptance limit of {} um (tolerance {:g} um, guard "
        "band {} um)",
        value, acceptance, micrometres(tolerance_mm),
        in_digits(known, tolerance_mm - limits.acceptance_mm));
  }
  if (verdict == Verdict::kDoesNotConform) {
    return core::phrase(
        "{} is above the rejection limit of {} um (tolerance {:g} um, guard "
        "band {} um)",
        value, rejection, micrometres(tolerance_mm),
        in_digits(known, limits.rejection_mm - tolerance_mm));
  }
  return core::phrase(
      "{} lies between the acceptance limit of {} um and the rejection limit of "
      "{} um about the tolerance of {:g} um: neither is proven",
      value, acceptance, rejection, micrometres(tolerance_mm));
}

core::Phrase probability_sentence(const DecisionRule& rule, double p_1, Verdict verdict) {
  const core::Phrase value =
      core::phrase("the probability of conformance is {:.4g} %", 100.0 * p_1);
  const double accept = 100.0 * (1.0 - rule.consumer_risk_1);
  const double reject = 100.0 * rule.producer_risk_1;
  if (verdict == Verdict::kConforms) return core::phrase("{}, at least {:g} %", value, accept);
  if (verdict == Verdict::kDoesNotConform) {
    return core::phrase("{}, at most {:g} %", value, reject);
  }
  return core::phrase("{}, between {:g} % and {:g} %", value, reject, accept);
}

/// Why a rule cannot be applied, or nothing.
std::optional<core::Phrase> obstacle(const DecisionRule& rule, const KnownValue& value,
                                     double tolerance_mm) {
  if (!rule.needs_interval()) return std::nullopt;
  if (!value.statement) {
    return core::phrase("the rule {} needs the interval {}, which was not computed",
                        core::Phrase(name_of(rule.kind)), core::Phrase(name_of(rule.measurand)));
  }
  const double width_mm = value.statement->high_mm - value.statement->low_mm;
  if (rule.kind == DecisionRule::Kind::kNToOne && !(tolerance_mm >= rule.ratio * width_mm)) {
    return core::phrase(
        "the rule {:g}:1 does not apply: the tolerance of {:g} um is {:.3g} times the interval of "
        "{:.3f} um",
        rule.ratio, micrometres(tolerance_mm), tolerance_mm / width_mm, micrometres(width_mm));
  }
  if (rule.kind == DecisionRule::Kind::kJcgm106 &&
      !conformance(*value.statement, rule.prior, 0.0, tolerance_mm)) {
    return rule.prior ? core::phrase(
                            "the stated prior leaves the measured value no weight: it speaks of "
                            "other parts than this one")
                      : core::phrase("the interval came without its distribution");
  }
  return std::nullopt;
}

core::Phrase verdict_sentence(const DecisionRule& rule, const KnownValue& value,
                              const Limits& limits, double tolerance_mm,
                              const RuleOutcome& outcome) {
  switch (rule.kind) {
    case DecisionRule::Kind::kSimpleAcceptance: {
      const std::string read = in_digits(value, limits.compared_mm);
      return simple_sentence(value.statement ? core::phrase("the value as read, {} um", read)
                                             : core::phrase("{} um", read),
                             value, limits, tolerance_mm);
    }
    case DecisionRule::Kind::kNToOne:
      return simple_sentence(corrected_value(value, limits), value, limits, tolerance_mm);
    case DecisionRule::Kind::kJcgm106:
      return probability_sentence(rule, *outcome.conformance_1, outcome.verdict);
    case DecisionRule::Kind::kIso14253:
    case DecisionRule::Kind::kGuardBand:
      return guarded_sentence(value, limits, tolerance_mm, outcome.verdict);
  }
  return {};
}

}  // namespace

std::optional<double> RuleOutcome::specific_risk_1() const {
  if (!conformance_1) return std::nullopt;
  if (verdict == Verdict::kConforms) return 1.0 - *conformance_1;
  if (verdict == Verdict::kDoesNotConform) return *conformance_1;
  return std::nullopt;
}

core::Result<RuleOutcome> apply_rule(const DecisionRule& rule, const KnownValue& value,
                                     double tolerance_mm) {
  if (const auto why = obstacle(rule, value, tolerance_mm)) return no_verdict(*why);
  const Limits limits = limits_of(rule, value, tolerance_mm);
  RuleOutcome out;
  out.compared_mm = limits.compared_mm;
  out.acceptance_mm = limits.acceptance_mm;
  out.rejection_mm = limits.rejection_mm;
  if (value.statement) {
    out.conformance_1 = conformance(*value.statement, rule.prior, 0.0, tolerance_mm);
  }
  // JCGM 106 decides by the probability itself; the limits are the values where it reaches its
  // bound.
  out.verdict = verdict_of(limits);
  if (rule.kind == DecisionRule::Kind::kJcgm106) {
    const double p = *out.conformance_1;
    out.verdict = p >= 1.0 - rule.consumer_risk_1 ? Verdict::kConforms
                  : p <= rule.producer_risk_1     ? Verdict::kDoesNotConform
                                                  : Verdict::kUndecided;
  }
  const bool read_above = value.measured_mm > tolerance_mm && !rule.judge_corrected;
  if (rule.needs_interval() && read_above && out.verdict == Verdict::kConforms) {
    out.verdict = Verdict::kUndecided;
    out.sentence = core::phrase(
        "read above the limit: {} um, the tolerance is {:g} um; the corrected value, {} um, is "
        "below: neither is proven",
        in_digits(value, value.measured_mm), micrometres(tolerance_mm),
        in_digits(value, limits.compared_mm));
    return out;
  }
  out.sentence = verdict_sentence(rule, value, limits, tolerance_mm, out);
  if (rule.needs_interval() && rule.judge_corrected) {
    out.sentence = core::phrase("{}; corrected values are judged, by agreement", out.sentence);
  }
  return out;
}

}  // namespace rondure::evaluation
