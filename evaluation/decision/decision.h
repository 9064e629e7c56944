#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/units.h"
#include "core/words.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "record/decision_rule.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Verdict on a value and its tolerance. kVoid: no verdict is possible because a condition is
/// missing.
enum class Verdict { kConforms, kDoesNotConform, kUndecided, kVoid, kNotToleranced };

RONDURE_WORDS(Verdict, {kConforms, "conforms"}, {kDoesNotConform, "does not conform"},
              {kUndecided, "undecided"}, {kVoid, "void"}, {kNotToleranced, "not toleranced"});

/// Severity of a verdict, for the verdict on several lines or on several limits of one: the most
/// severe is that of all. From the least: not toleranced, conforms, undecided, void, does not
/// conform. What does not conform is proven, whatever else could not be judged.
[[nodiscard]] int severity(Verdict verdict);

/// Prior knowledge: the distribution of the form deviation of parts of this kind before
/// measurement. Zero below 0 mm, because no form deviation is negative.
struct Prior {
  using Kind = record::PriorTask::Distribution;
  Kind kind = Kind::kGamma;
  double mean_mm = 0.0;                ///< > 0. Mean of the normal distribution before truncation.
  double standard_deviation_mm = 0.0;  ///< > 0; for kGamma at most the mean.

  /// Density at a value, up to a common factor.
  [[nodiscard]] double density(double value_mm) const;
};

/// Limits of a value; at least one. Form deviations have the upper one, the tolerance T; sizes may
/// have both.
struct Limits {
  std::optional<double> lower_mm = {};
  std::optional<double> upper_mm = {};

  /// Whether a value is within them. The limits themselves are.
  [[nodiscard]] bool hold(double value_mm) const {
    return (!lower_mm || value_mm >= *lower_mm) && (!upper_mm || value_mm <= *upper_mm);
  }
};

/// How a value and its limits give a verdict.
struct DecisionRule {
  using Kind = record::DecisionRuleTask::Rule;
  Kind kind = Kind::kSimpleAcceptance;
  Measurand measurand = Measurand::kSampledPoints;  ///< Subject of the verdict.
  /// false: a measured value above the tolerance never conforms. true: by agreement of the parties
  /// only the corrected value counts.
  bool judge_corrected = false;
  double guard_factor =
      record::DecisionRuleTask().guard_factor;  ///< kIso14253: guard band in parts of the interval.
  double consumer_risk_1 =
      0.01 * record::DecisionRuleTask()
                 .consumer_risk_percent;  ///< kJcgm106: of an accepted part, at most.
  double producer_risk_1 =
      0.01 *
      record::DecisionRuleTask().producer_risk_percent;  ///< kJcgm106: of a rejected part, at most.
  std::optional<Prior> prior = {};
  double ratio = record::DecisionRuleTask().ratio;  ///< kNToOne: N.
  double acceptance_guard_1 =
      0.01 * record::DecisionRuleTask()
                 .acceptance_guard_percent;  ///< kGuardBand: in parts of U; < 0: relaxed.
  double rejection_guard_1 =
      0.01 * record::DecisionRuleTask()
                 .rejection_guard_percent;  ///< kGuardBand: in parts of U; < 0: relaxed.
  /// The statements that ASME B89.7.3.1 requires, as the plan words them.
  std::string zones = {};
  std::string outcomes = {};
  std::string repeats = {};
  std::string outliers = {};

  [[nodiscard]] bool needs_interval() const { return kind != Kind::kSimpleAcceptance; }
};

[[nodiscard]] Measurand measurand_of(record::DecisionRuleTask::Measurand asked);

[[nodiscard]] DecisionRule rule_of(const record::DecisionRuleTask& task);

/// The rule of a run: its name from the head, the rest from its settings ("decision_rule/...").
/// kMeaning for a rule, measurand, judged value or prior that this program does not
/// know: every verdict is then void.
[[nodiscard]] core::Result<DecisionRule> rule_of(const record::RunRecord& record);

/// A measured value with its uncertainty statement.
struct KnownValue {
  double measured_mm = 0.0;  ///< Value of the points as read, not corrected.
  std::optional<UncertaintyStatement> statement = {};
  core::ValueUnit unit = core::ValueUnit::kUm;  ///< In sentences; of a size mm, of an angle urad.
  /// Between both limits of its characteristic, where the value is held against one of them only.
  std::optional<double> tolerance_mm = {};
};

/// Probabilities over all parts of the stated prior, for this measurement.
struct GlobalRisks {
  double false_acceptance_1 = 0.0;  ///< Probability that a part does not conform and is accepted.
  double false_rejection_1 = 0.0;   ///< Probability that a part conforms and is rejected.
};

/// Result of applying a rule to a value.
struct RuleOutcome {
  Verdict verdict = Verdict::kUndecided;  ///< Never void: that is an error.
  core::Phrase sentence;                  ///< Why, with numbers.
  double compared_mm = 0.0;  ///< The measured value (simple acceptance) or the corrected one.
  Limits acceptance = {};    ///< A value within these conforms: the limits less the guard bands.
  Limits rejection = {};     ///< A value beyond these does not: the limits plus the guard bands.
  /// Probability that the part conforms; none under a rule that takes no uncertainty into account.
  std::optional<double> conformance_1 = {};

  /// Probability that this verdict is wrong: the specific consumer's risk of an accepted part, the
  /// specific producer's risk of a rejected one. None while undecided or without an interval.
  [[nodiscard]] std::optional<double> specific_risk_1() const;
};

/// Applies a rule. Pure.
///
/// The errors of the value are assumed to have the same distribution for every part of this kind:
/// that of the statement, shifted. `y` is the corrected value, [lo, hi] its interval, U = (hi - lo)
/// / 2, P the probability that the part conforms:
///   simple acceptance  conforms where the measured value <= T; undecided where a stated interval
///                      lies or reaches beyond T although the value was read within it
///   ISO 14253-1        y + f (hi - y) <= T conforms, y - f (y - lo) > T does not, else undecided
///   JCGM 106           P >= 1 - R_c conforms, P <= R_p does not, else undecided
///   N:1                only where T >= N (hi - lo): y <= T conforms, else does not
///   guard band         y <= T - a U conforms, y > T + r U does not, else undecided
/// At a lower limit the same holds mirrored. With two limits a part conforms that conforms at both,
/// and does not where it does not at one; P is the probability to lie between them, and N:1
/// compares with their distance. One limit of a size leaves N:1 no tolerance.
/// Under every rule, a measured value beyond a limit does not conform unless corrected values are
/// judged: the correction grows with the declared noise, and the party that benefits declares it.
/// A statement with `at_most` is an upper bound: besides what the rule asks, hi <= T must hold to
/// conform and lo > T not to, whatever the guard factor and the risks; else the verdict is void.
/// Two limits nearer than the ends of the interval leave it undecided (capability), unless the
/// whole interval lies beyond one of them.
/// @param limits  At least one; the lower below the upper. T > 0.
/// @return  The outcome; or kMeaning with the reason for a void verdict: no interval for the
///          measurand of the rule, N:1 does not apply, the prior gives the measurement no weight,
///          an upper bound that proves nothing.
/// Sources: ISO 14253-1:2017; JCGM 106:2012, 7 to 9; ASME B89.7.3.1-2001.
[[nodiscard]] core::Result<RuleOutcome> apply_rule(const DecisionRule& rule,
                                                   const KnownValue& value, const Limits& limits);

/// Global risks (JCGM 106, clause 9) of the outcome of apply_rule(), over the prior of the rule,
/// where the errors of the compared value are distributed as in the statement for every part, and
/// the value as read exceeds the compared one by as much as here: a part counts as accepted only
/// where every condition of apply_rule() lets it conform, a part left undecided or void as neither.
/// None without a prior or a distribution, or under a rule that takes no uncertainty into account.
[[nodiscard]] std::optional<GlobalRisks> global_risks(const DecisionRule& rule,
                                                      const KnownValue& value,
                                                      const RuleOutcome& outcome,
                                                      const Limits& limits);

}  // namespace rondure::evaluation
