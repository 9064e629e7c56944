#include "reports/words/decision.h"

#include "core/units.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

std::string formula(const evaluation::DecisionRule& rule) {
  switch (rule.kind) {
    case evaluation::DecisionRule::Kind::kSimpleAcceptance:
      return tr("simple acceptance: conforms where the measured value <= T; no guard band");
    case evaluation::DecisionRule::Kind::kIso14253:
      return trf(
          "ISO 14253-1: conforms where y + f (hi - y) <= T, does not conform where y - f (y - lo) "
          "> T, otherwise undecided; f = {:g}",
          rule.guard_factor);
    case evaluation::DecisionRule::Kind::kJcgm106:
      return trf(
          "JCGM 106: conforms where the probability of conformance P >= {:g} %, does not conform "
          "where P <= {:g} %, otherwise undecided",
          100.0 * (1.0 - rule.consumer_risk_1), 100.0 * rule.producer_risk_1);
    case evaluation::DecisionRule::Kind::kNToOne:
      return trf(
          "{0:g}:1 simple acceptance (ASME B89.7.3.1): where T >= {0:g} (hi - lo), conforms where "
          "y <= T, otherwise does not conform; void where the ratio is not met",
          rule.ratio);
    case evaluation::DecisionRule::Kind::kGuardBand:
      return trf(
          "guard bands (ASME B89.7.3.1): conforms where y <= T - a U, does not conform where y > T "
          "+ r U, otherwise undecided; a = {:g} %, r = {:g} %",
          100.0 * rule.acceptance_guard_1, 100.0 * rule.rejection_guard_1);
  }
  return {};
}

}  // namespace

std::string in_words(const evaluation::DecisionRule& rule) {
  std::string out = formula(rule);
  if (rule.needs_interval()) {
    out = rule.judge_corrected ? trf("{}; corrected values are judged, whatever was read", out)
                               : trf("{}; a value as read above T never conforms", out);
  }
  if (!rule.prior) return out;
  return trf("{}; prior: {} with mean {:g} um and standard deviation {:g} um", out,
             tr(name_of(rule.prior->kind)), rule.prior->mean_mm / core::kMicrometre,
             rule.prior->standard_deviation_mm / core::kMicrometre);
}

}  // namespace rondure::reports
