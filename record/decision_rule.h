#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "record/key_spec.h"

namespace rondure::record {

/// Knowledge of the parts before this one was measured.
struct PriorTask {
  enum class Distribution { kGamma, kNormal };  ///< kNormal is cut at 0.

  Distribution distribution = Distribution::kGamma;
  double mean_um = 0.0;
  double standard_deviation_um = 0.0;
};

RONDURE_WORDS(PriorTask::Distribution, {kGamma, "gamma"}, {kNormal, "normal"});

/// How a value and its tolerance make a verdict, as plan and journal spell it. A member initialiser
/// is the default of its key.
struct DecisionRuleTask {
  enum class Rule { kSimpleAcceptance, kIso14253, kJcgm106, kNToOne, kGuardBand };
  enum class Measurand { kSampledPoints, kWholeSurface };
  enum class Judge { kAsRead, kCorrected };

  Rule rule = Rule::kSimpleAcceptance;
  Measurand measurand = Measurand::kSampledPoints;
  Judge judge = Judge::kAsRead;
  double guard_factor = 1.0;           ///< For kIso14253.
  double consumer_risk_percent = 5.0;  ///< For kJcgm106.
  double producer_risk_percent = 5.0;  ///< For kJcgm106.
  std::optional<PriorTask> prior;
  double ratio = 4.0;                       ///< N of kNToOne.
  double acceptance_guard_percent = 100.0;  ///< For kGuardBand.
  double rejection_guard_percent = 100.0;   ///< For kGuardBand.
  // The statements of ASME B89.7.3.1; needed by kNToOne and kGuardBand.
  std::string zones;
  std::string outcomes;
  std::string repeats;
  std::string outliers;
};

RONDURE_WORDS(DecisionRuleTask::Rule, {kSimpleAcceptance, "simple-acceptance"},
              {kIso14253, "iso-14253-1"}, {kJcgm106, "jcgm-106"}, {kNToOne, "n-to-1"},
              {kGuardBand, "guard-band"});
RONDURE_WORDS(DecisionRuleTask::Measurand, {kSampledPoints, "sampled-points"},
              {kWholeSurface, "whole-surface"});
RONDURE_WORDS(DecisionRuleTask::Judge, {kAsRead, "as-read"}, {kCorrected, "corrected"});

template <class Visitor>
void describe(Visitor& v, PriorTask& p) {
  const auto size = [](std::string_view meaning) {
    return required(above(0.0, 10'000.0, meaning));
  };
  v.text("distribution", p.distribution,
         {.meaning = "Of the form deviation over the parts of the process; normal: cut at 0."});
  v.number("mean_um", p.mean_um, size("Its mean."));
  v.number("standard_deviation_um", p.standard_deviation_um,
           size("Its standard deviation; of gamma at most the mean."));
}

template <class Visitor>
void describe_statements(Visitor& v, DecisionRuleTask& p) {
  v.text("zones", p.zones,
         {.meaning = "Statement of ASME B89.7.3.1: the zones and their sizes. n-to-1 and "
                     "guard-band need this and the next three."});
  v.text("outcomes", p.outcomes, {.meaning = "Statement: what is done with a part in each zone."});
  v.text("repeats", p.repeats, {.meaning = "Statement: treatment of repeated measurements."});
  v.text("outliers", p.outliers, {.meaning = "Statement: treatment of values that do not belong."});
}

template <class Visitor>
void describe(Visitor& v, DecisionRuleTask& p) {
  v.text(
      "rule", p.rule,
      {.meaning = "simple-acceptance compares the value with the tolerance, without uncertainty. "
                  "The others need uncertainty and may end undecided (docs/decision-rules.md)."});
  v.text("measurand", p.measurand,
         {.meaning = "Subject of the verdict: the surface at the sampled points, or the whole "
                     "surface under the form spectrum."});
  v.text("judge", p.judge,
         {.meaning = "as-read: a value read above the tolerance never conforms. corrected: only "
                     "the value corrected for noise and its interval count, by agreement of both "
                     "parties; the report says so."});
  v.number("guard_factor", p.guard_factor,
           range(0.0, 10.0, "iso-14253-1: guard band in parts of the interval beside the value."));
  v.number(
      "consumer_risk_percent", p.consumer_risk_percent,
      above(0.0, 50.0, "jcgm-106: largest probability that an accepted part does not conform."));
  v.number("producer_risk_percent", p.producer_risk_percent,
           above(0.0, 50.0, "jcgm-106: largest probability that a rejected part conforms."));
  v.object("prior", p.prior,
           {.meaning = "Knowledge of the process before the measurement. The report then states "
                       "the global risks, and jcgm-106 uses it."});
  v.number("ratio", p.ratio,
           range(1.0, 100.0, "n-to-1: N, tolerance over the width of the interval at least."));
  v.number("acceptance_guard_percent", p.acceptance_guard_percent,
           within(1000.0, "guard-band: below the tolerance, in percent of U; < 0: relaxed."));
  v.number("rejection_guard_percent", p.rejection_guard_percent,
           within(1000.0, "guard-band: above the tolerance, in percent of U; < 0: relaxed."));
  describe_statements(v, p);
}

}  // namespace rondure::record
