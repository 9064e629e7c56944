#include "evaluation/decision/decision.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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

/// Whether the whole interval lies beyond a limit.
bool beyond(const UncertaintyStatement& known, const Limits& limits) {
  return (limits.upper_mm && known.low_mm > *limits.upper_mm) ||
         (limits.lower_mm && known.high_mm < *limits.lower_mm);
}

/// Acceptance and rejection limits of a rule, on the scale of the compared value.
struct Zones {
  double compared_mm = 0.0;
  Limits acceptance;
  Limits rejection;
};

Verdict verdict_of(const Zones& zones) {
  if (zones.acceptance.hold(zones.compared_mm)) return Verdict::kConforms;
  return zones.rejection.hold(zones.compared_mm) ? Verdict::kUndecided : Verdict::kDoesNotConform;
}

/// The value nearest to a limit at which the probability of conformance is still at least `least`,
/// found by shifting the distribution.
/// @param limit_mm   The limit.
/// @param inside_mm  A value that surely conforms; with two limits, the middle between them.
/// @param beyond_mm  A value beyond the limit that surely does not.
double limit_at(const UncertaintyStatement& known, const std::optional<Prior>& prior,
                const Limits& limits, double limit_mm, double inside_mm, double beyond_mm,
                double least) {
  const bool upper = beyond_mm > inside_mm;
  for (int i = 0; i < 40; ++i) {
    const double middle_mm = 0.5 * (inside_mm + beyond_mm);
    const auto p = conformance(known, prior, middle_mm - known.estimate_mm, limits);
    // Where the prior gives the distribution no weight, the middle of the distribution decides on
    // which side of the limit the part lies.
    const bool enough = p ? *p >= least : upper ? middle_mm < limit_mm : middle_mm > limit_mm;
    (enough ? inside_mm : beyond_mm) = middle_mm;
  }
  return inside_mm;
}

/// The values at which the probability of conformance reaches `least`. Where even the middle of two
/// limits does not, both are that middle.
Limits limits_at(const UncertaintyStatement& known, const std::optional<Prior>& prior,
                 const Limits& limits, double least) {
  const double spread_mm = known.values_mm.back() - known.values_mm.front();
  const auto& [lower_mm, upper_mm] = limits;
  Limits out;
  if (lower_mm && upper_mm) {
    const double inside_mm = 0.5 * (*lower_mm + *upper_mm);
    const double span_mm = spread_mm + (*upper_mm - *lower_mm);
    out.lower_mm =
        limit_at(known, prior, limits, *lower_mm, inside_mm, *lower_mm - 2.0 * span_mm, least);
    out.upper_mm =
        limit_at(known, prior, limits, *upper_mm, inside_mm, *upper_mm + 2.0 * span_mm, least);
    return out;
  }
  const double limit_mm = upper_mm ? *upper_mm : *lower_mm;
  const double span_mm = spread_mm + std::abs(limit_mm);
  const double low_mm = limit_mm - 2.0 * span_mm;
  const double high_mm = limit_mm + 2.0 * span_mm;
  if (upper_mm) {
    out.upper_mm = limit_at(known, prior, limits, limit_mm, low_mm, high_mm, least);
  } else {
    out.lower_mm = limit_at(known, prior, limits, limit_mm, high_mm, low_mm, least);
  }
  return out;
}

/// Limits with a band on the inner side of each; < 0: on the outer side.
Limits narrowed(Limits limits, double lower_band_mm, double upper_band_mm) {
  if (limits.lower_mm) *limits.lower_mm += lower_band_mm;
  if (limits.upper_mm) *limits.upper_mm -= upper_band_mm;
  return limits;
}

Zones zones_of(const DecisionRule& rule, const KnownValue& value, const Limits& limits) {
  using Kind = DecisionRule::Kind;
  Zones out{value.measured_mm, limits, limits};
  if (!rule.needs_interval()) return out;
  const UncertaintyStatement& known = *value.statement;
  out.compared_mm = known.estimate_mm;
  if (rule.kind == Kind::kIso14253) {
    const double above_mm = rule.guard_factor * (known.high_mm - known.estimate_mm);
    const double below_mm = rule.guard_factor * (known.estimate_mm - known.low_mm);
    out.acceptance = narrowed(limits, below_mm, above_mm);
    out.rejection = narrowed(limits, -above_mm, -below_mm);
  } else if (rule.kind == Kind::kGuardBand) {
    const double inner_mm = rule.acceptance_guard_1 * known.expanded_mm();
    const double outer_mm = rule.rejection_guard_1 * known.expanded_mm();
    out.acceptance = narrowed(limits, inner_mm, inner_mm);
    out.rejection = narrowed(limits, -outer_mm, -outer_mm);
  } else if (rule.kind == Kind::kJcgm106) {
    out.acceptance = limits_at(known, rule.prior, limits, 1.0 - rule.consumer_risk_1);
    out.rejection = limits_at(known, rule.prior, limits, rule.producer_risk_1);
  }
  return out;
}

/// A length in um, an angle in urad, with one digit more than the uncertainty warrants.
std::string in_digits(const KnownValue& value, double length_mm) {
  const int decimals = value.statement ? decimals_for(value.statement->expanded_mm()) + 1 : 3;
  return fixed(micrometres(length_mm), decimals);
}

/// A number of micrometres or microradians with that unit.
std::string with_small_unit(const KnownValue& value, const std::string& number) {
  return fmt::format("{} {}", number, core::name_of(core::unit_of_difference(value.unit)));
}

/// "0.312 um": a difference of values, in um also of sizes.
std::string difference(const KnownValue& value, double length_mm) {
  return with_small_unit(value, in_digits(value, length_mm));
}

/// "12 um": a tolerance as a plan states it.
std::string tolerance_text(const KnownValue& value, double length_mm) {
  return with_small_unit(value, fmt::format("{:g}", micrometres(length_mm)));
}

/// "0.312 um": the width of an interval.
std::string width_text(const KnownValue& value, double length_mm) {
  return with_small_unit(value, fmt::format("{:.3f}", micrometres(length_mm)));
}

/// The limit that a value is nearest to, or farthest beyond, with those of the rule beside it.
struct NearestLimit {
  bool upper = true;
  double limit_mm = 0.0;
  double acceptance_mm = 0.0;
  double rejection_mm = 0.0;
};

NearestLimit nearest_limit(const Limits& limits, const Zones& zones) {
  const bool upper = limits.upper_mm &&
                     (!limits.lower_mm ||
                      *limits.upper_mm - zones.compared_mm <= zones.compared_mm - *limits.lower_mm);
  if (upper) return {true, *limits.upper_mm, *zones.acceptance.upper_mm, *zones.rejection.upper_mm};
  return {false, *limits.lower_mm, *zones.acceptance.lower_mm, *zones.rejection.lower_mm};
}

/// A value with its unit, which is mm for a size.
std::string with_unit(const KnownValue& value, double length_mm) {
  if (value.unit != core::ValueUnit::kMm) return difference(value, length_mm);
  const int decimals = value.statement ? decimals_for(value.statement->expanded_mm()) + 1 : 3;
  return core::length_in(value.unit, length_mm, decimals) + " mm";
}

/// A limit with its unit, as a drawing states it: to the nanometre at most.
std::string limit_text(const KnownValue& value, double limit_mm) {
  constexpr double kSteps = 1e6;
  return value.unit == core::ValueUnit::kMm
             ? core::shortest(core::on_grid(limit_mm, kSteps)) + " mm"
             : with_small_unit(value, fixed(micrometres(limit_mm), 3));
}

/// Whether sentences speak of "the tolerance": a form deviation with its one limit.
bool has_tolerance(const KnownValue& value, const Limits& limits) {
  return !limits.lower_mm && value.unit != core::ValueUnit::kMm;
}

core::Phrase side_of(const NearestLimit& limit) {
  return limit.upper ? core::phrase("upper") : core::phrase("lower");
}

/// "7.958 um is within the tolerance of 12 um by 4.042 um".
core::Phrase simple_sentence(const core::Phrase& text, const KnownValue& value,
                             const Limits& limits, const Zones& zones) {
  const NearestLimit limit = nearest_limit(limits, zones);
  const double apart_mm = std::abs(limit.limit_mm - zones.compared_mm);
  std::string by = in_digits(value, apart_mm);
  // "by 0.000 um" beyond a limit reads as if the value held it.
  const bool vanishes = by.find_first_not_of("0.") == std::string::npos;
  if (vanishes && !limits.hold(zones.compared_mm))
    by = fmt::format("{:.2g}", micrometres(apart_mm));
  by = with_small_unit(value, by);
  if (has_tolerance(value, limits)) {
    return core::phrase(
        "{} is {} the tolerance of {} by {}", text,
        limits.hold(zones.compared_mm) ? core::phrase("within") : core::phrase("above"),
        tolerance_text(value, limit.limit_mm), by);
  }
  return core::phrase(
      "{} is {} the {} limit of {} by {}", text,
      limits.hold(zones.compared_mm) ? core::phrase("within") : core::phrase("beyond"),
      side_of(limit), limit_text(value, limit.limit_mm), by);
}

core::Phrase corrected_value(const KnownValue& value, const Zones& zones) {
  return core::phrase("the corrected value {}", with_unit(value, zones.compared_mm));
}

/// The sentence about a value with a lower limit, which names the limit that it is nearest to.
core::Phrase guarded_between(const KnownValue& known, const Zones& zones, const NearestLimit& limit,
                             Verdict verdict) {
  const core::Phrase value = corrected_value(known, zones);
  const std::string acceptance = with_unit(known, limit.acceptance_mm);
  const std::string rejection = with_unit(known, limit.rejection_mm);
  const std::string stated = limit_text(known, limit.limit_mm);
  if (verdict == Verdict::kConforms) {
    return core::phrase("{} is within the acceptance limit of {} ({} limit {}, guard band {})",
                        value, acceptance, side_of(limit), stated,
                        difference(known, std::abs(limit.limit_mm - limit.acceptance_mm)));
  }
  if (verdict == Verdict::kDoesNotConform) {
    return core::phrase("{} is beyond the rejection limit of {} ({} limit {}, guard band {})",
                        value, rejection, side_of(limit), stated,
                        difference(known, std::abs(limit.rejection_mm - limit.limit_mm)));
  }
  return core::phrase(
      "{} lies between the acceptance limit of {} and the rejection limit of {} about the {} "
      "limit of {}: neither is proven",
      value, acceptance, rejection, side_of(limit), stated);
}

core::Phrase guarded_sentence(const KnownValue& known, const Limits& limits, const Zones& zones,
                              Verdict verdict) {
  const NearestLimit limit = nearest_limit(limits, zones);
  if (!has_tolerance(known, limits)) return guarded_between(known, zones, limit, verdict);
  const core::Phrase value = corrected_value(known, zones);
  const std::string acceptance = with_unit(known, limit.acceptance_mm);
  const std::string rejection = with_unit(known, limit.rejection_mm);
  if (verdict == Verdict::kConforms) {
    return core::phrase("{} is within the acceptance limit of {} (tolerance {}, guard band {})",
                        value, acceptance, tolerance_text(known, limit.limit_mm),
                        difference(known, limit.limit_mm - limit.acceptance_mm));
  }
  if (verdict == Verdict::kDoesNotConform) {
    return core::phrase("{} is above the rejection limit of {} (tolerance {}, guard band {})",
                        value, rejection, tolerance_text(known, limit.limit_mm),
                        difference(known, limit.rejection_mm - limit.limit_mm));
  }
  return core::phrase(
      "{} lies between the acceptance limit of {} and the rejection limit of {} about the "
      "tolerance of {}: neither is proven",
      value, acceptance, rejection, tolerance_text(known, limit.limit_mm));
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

/// The tolerance of a value, or nothing: a form deviation lies between 0 and its limit, a size with
/// one limit anywhere beyond it.
std::optional<double> tolerance_of(const KnownValue& value, const Limits& limits) {
  if (value.tolerance_mm) return value.tolerance_mm;
  if (!limits.upper_mm) return std::nullopt;
  if (limits.lower_mm) return *limits.upper_mm - *limits.lower_mm;
  return value.unit == core::ValueUnit::kMm ? std::nullopt : limits.upper_mm;
}

/// Why a value and its limits have no ratio N:1, or nothing.
std::optional<core::Phrase> obstacle_to_ratio(const DecisionRule& rule, const KnownValue& value,
                                              const Limits& limits) {
  const double width_mm = value.statement->high_mm - value.statement->low_mm;
  const auto tolerance = tolerance_of(value, limits);
  if (!tolerance && limits.upper_mm) {
    return core::phrase(
        "the rule {:g}:1 does not apply: one upper limit of a size leaves no tolerance to compare "
        "with; plan both limits, or another rule",
        rule.ratio);
  }
  if (!tolerance) {
    return core::phrase(
        "the rule {:g}:1 does not apply: one lower limit leaves no tolerance to compare with",
        rule.ratio);
  }
  const double tolerance_mm = *tolerance;
  if (tolerance_mm >= rule.ratio * width_mm) return std::nullopt;
  return core::phrase(
      "the rule {:g}:1 does not apply: the tolerance of {} is {:.3g} times the interval of {}",
      rule.ratio, tolerance_text(value, tolerance_mm), tolerance_mm / width_mm,
      width_text(value, width_mm));
}

/// Why a rule cannot be applied, or nothing.
std::optional<core::Phrase> obstacle(const DecisionRule& rule, const KnownValue& value,
                                     const Limits& limits) {
  if (!rule.needs_interval()) return std::nullopt;
  if (!value.statement) {
    return core::phrase("the rule {} needs the interval {}, which was not computed",
                        core::Phrase(name_of(rule.kind)), core::Phrase(name_of(rule.measurand)));
  }
  if (rule.kind == DecisionRule::Kind::kNToOne) return obstacle_to_ratio(rule, value, limits);
  if (rule.kind == DecisionRule::Kind::kJcgm106 &&
      !conformance(*value.statement, rule.prior, 0.0, limits)) {
    return rule.prior ? core::phrase(
                            "the stated prior leaves the measured value no weight: it speaks of "
                            "other parts than this one")
                      : core::phrase("the interval came without its distribution");
  }
  return std::nullopt;
}

core::Phrase verdict_sentence(const DecisionRule& rule, const KnownValue& value,
                              const Limits& limits, const Zones& zones,
                              const RuleOutcome& outcome) {
  switch (rule.kind) {
    case DecisionRule::Kind::kSimpleAcceptance: {
      const std::string read = with_unit(value, zones.compared_mm);
      return simple_sentence(
          value.statement ? core::phrase("the value as read, {}", read) : core::as_it_is(read),
          value, limits, zones);
    }
    case DecisionRule::Kind::kNToOne:
      return simple_sentence(corrected_value(value, zones), value, limits, zones);
    case DecisionRule::Kind::kJcgm106:
      return probability_sentence(rule, *outcome.conformance_1, outcome.verdict);
    case DecisionRule::Kind::kIso14253:
    case DecisionRule::Kind::kGuardBand:
      return guarded_sentence(value, limits, zones, outcome.verdict);
  }
  return {};
}

/// The limit that an upper bound of a value is held against: the upper one where there is one.
double limit_of_bound(const Limits& limits) {
  return limits.upper_mm ? *limits.upper_mm : *limits.lower_mm;
}

/// Whether a bound proves the verdict of a rule by itself, whatever a guard factor below 1 or a
/// risk allows. An upper bound proves no lower limit, but 0, which no such value is below.
bool bound_proves(const UncertaintyStatement& known, const Limits& limits, Verdict verdict) {
  if (verdict == Verdict::kConforms) {
    const bool above = !limits.lower_mm || *limits.lower_mm <= 0.0;
    return above && (!limits.upper_mm || known.high_mm <= *limits.upper_mm);
  }
  return verdict == Verdict::kDoesNotConform && beyond(known, limits);
}

/// Why there is no verdict on a value of which only an upper bound is known, or nothing.
std::optional<core::Phrase> obstacle_to_bound(const DecisionRule& rule, const KnownValue& value,
                                              const Limits& limits, Verdict verdict) {
  if (bound_proves(*value.statement, limits, verdict)) return std::nullopt;
  return core::phrase(
      "noise and influences make up so much of the value that it is only known to be at most {}; "
      "under the rule {} that proves nothing at the {} limit of {}: lower the noise, or average "
      "more readings",
      with_unit(value, value.statement->high_mm), core::Phrase(name_of(rule.kind)),
      limits.upper_mm ? core::phrase("upper") : core::phrase("lower"),
      limit_text(value, limit_of_bound(limits)));
}

/// The sentence about a value of which only an upper bound is known.
core::Phrase bound_sentence(const KnownValue& value, const Limits& limits, Verdict verdict) {
  const UncertaintyStatement& known = *value.statement;
  if (verdict == Verdict::kConforms) {
    return core::phrase(
        "the value is at most {}, within the limit of {}; noise and influences hide the rest",
        with_unit(value, known.high_mm), limit_text(value, limit_of_bound(limits)));
  }
  if (limits.upper_mm && known.low_mm > *limits.upper_mm) {
    return core::phrase(
        "the whole interval lies beyond the limit of {}: it begins at {}, although noise and "
        "influences make up much of the value as read",
        limit_text(value, *limits.upper_mm), with_unit(value, known.low_mm));
  }
  return core::phrase("the value is at most {}, below the lower limit of {}",
                      with_unit(value, known.high_mm), limit_text(value, *limits.lower_mm));
}

/// Why two limits that are closer than the ends of the interval leave a verdict open, or nothing.
/// Where the whole interval lies beyond a limit the verdict stands.
std::optional<core::Phrase> incapability(const KnownValue& value, const Limits& limits,
                                         Verdict verdict) {
  const UncertaintyStatement& known = *value.statement;
  if (!limits.lower_mm || !limits.upper_mm) return std::nullopt;
  const double width_mm = known.high_mm - known.low_mm;
  const double apart_mm = *limits.upper_mm - *limits.lower_mm;
  if (width_mm <= apart_mm) return std::nullopt;
  if (verdict == Verdict::kDoesNotConform && beyond(known, limits)) return std::nullopt;
  return core::phrase(
      "capability: the interval is {} wide, the limits are {} apart; no value can be proven to lie "
      "between them",
      width_text(value, width_mm), tolerance_text(value, apart_mm));
}

/// Why a value that was read beyond a limit is undecided although its corrected value is within.
core::Phrase read_beyond_sentence(const KnownValue& value, const Limits& limits,
                                  double corrected_mm) {
  if (value.statement->at_most) {
    return core::phrase(
        "read beyond the limit of {}: {}; free of noise and influences it is at most {}, within "
        "the "
        "limit: neither verdict is proven",
        limit_text(value, limit_of_bound(limits)), with_unit(value, value.measured_mm),
        with_unit(value, value.statement->high_mm));
  }
  if (has_tolerance(value, limits)) {
    return core::phrase(
        "read above the limit: {}, the tolerance is {}; the corrected value, {}, is below: neither "
        "is proven",
        with_unit(value, value.measured_mm), tolerance_text(value, *limits.upper_mm),
        with_unit(value, corrected_mm));
  }
  const bool below = limits.lower_mm && value.measured_mm < *limits.lower_mm;
  return core::phrase(
      "read beyond the {} limit: {}, the limit is {}; the corrected value, {}, is within: neither "
      "is "
      "proven",
      below ? core::phrase("lower") : core::phrase("upper"), with_unit(value, value.measured_mm),
      limit_text(value, below ? *limits.lower_mm : *limits.upper_mm),
      with_unit(value, corrected_mm));
}

/// Why a value that was read within its limits is undecided: its interval lies or reaches beyond
/// one of them. Nothing where it does neither.
std::optional<core::Phrase> refuted_sentence(const KnownValue& value, const Limits& limits) {
  const UncertaintyStatement& known = *value.statement;
  const bool above = limits.upper_mm && known.high_mm > *limits.upper_mm;
  if (!above && !(limits.lower_mm && known.low_mm < *limits.lower_mm)) return std::nullopt;
  const std::string limit = limit_text(value, above ? *limits.upper_mm : *limits.lower_mm);
  const std::string read = with_unit(value, value.measured_mm);
  if (known.at_most) {
    return core::phrase(
        "read within the limit of {}: {}; free of noise and influences it is at most {}: neither "
        "is proven",
        limit, read, with_unit(value, known.high_mm));
  }
  return core::phrase(
      "read within the limit of {}: {}; its interval, {} to {}, {} it: neither is proven", limit,
      read, with_unit(value, known.low_mm), with_unit(value, known.high_mm),
      beyond(known, limits) ? core::phrase("lies beyond") : core::phrase("reaches beyond"));
}

}  // namespace

std::optional<double> RuleOutcome::specific_risk_1() const {
  if (!conformance_1) return std::nullopt;
  if (verdict == Verdict::kConforms) return 1.0 - *conformance_1;
  if (verdict == Verdict::kDoesNotConform) return *conformance_1;
  return std::nullopt;
}

core::Result<RuleOutcome> apply_rule(const DecisionRule& rule, const KnownValue& value,
                                     const Limits& limits) {
  if (const auto why = obstacle(rule, value, limits)) return no_verdict(*why);
  const Zones zones = zones_of(rule, value, limits);
  RuleOutcome out;
  out.compared_mm = zones.compared_mm;
  out.acceptance = zones.acceptance;
  out.rejection = zones.rejection;
  if (rule.needs_interval()) {
    out.conformance_1 = conformance(*value.statement, rule.prior, 0.0, limits);
  }
  // JCGM 106 decides by the probability itself; the limits are the values where it reaches its
  // bound.
  out.verdict = verdict_of(zones);
  if (rule.kind == DecisionRule::Kind::kJcgm106) {
    const double p = *out.conformance_1;
    out.verdict = p >= 1.0 - rule.consumer_risk_1 ? Verdict::kConforms
                  : p <= rule.producer_risk_1     ? Verdict::kDoesNotConform
                                                  : Verdict::kUndecided;
  }
  if (!rule.needs_interval() && value.statement && out.verdict == Verdict::kConforms) {
    if (auto why = refuted_sentence(value, limits)) {
      out.verdict = Verdict::kUndecided;
      out.sentence = *std::move(why);
      return out;
    }
  }
  const bool bound = rule.needs_interval() && value.statement->at_most;
  if (bound) {
    if (const auto why = obstacle_to_bound(rule, value, limits, out.verdict)) {
      return no_verdict(*why);
    }
  }
  if (rule.needs_interval()) {
    if (auto why = incapability(value, limits, out.verdict)) {
      out.verdict = Verdict::kUndecided;
      out.sentence = *std::move(why);
      return out;
    }
  }
  const bool read_beyond = !limits.hold(value.measured_mm) && !rule.judge_corrected;
  if (rule.needs_interval() && read_beyond && out.verdict == Verdict::kConforms) {
    out.verdict = Verdict::kUndecided;
    out.sentence = read_beyond_sentence(value, limits, zones.compared_mm);
    return out;
  }
  out.sentence = bound ? bound_sentence(value, limits, out.verdict)
                       : verdict_sentence(rule, value, limits, zones, out);
  if (rule.needs_interval() && rule.judge_corrected) {
    out.sentence = core::phrase("{}; corrected values are judged, by agreement", out.sentence);
  }
  return out;
}

}  // namespace rondure::evaluation
