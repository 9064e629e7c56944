#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::DecisionRuleTask;
using Rule = DecisionRuleTask::Rule;

/// Checks the four statements of ASME B89.7.3.1: needed by its rules, without effect under others.
void check_statements(const DecisionRuleTask& rule, Findings& findings) {
  const bool needed = rule.rule == Rule::kNToOne || rule.rule == Rule::kGuardBand;
  const std::array<std::pair<std::string_view, std::string_view>, 4> statements = {
      {{"zones", rule.zones},
       {"outcomes", rule.outcomes},
       {"repeats", rule.repeats},
       {"outliers", rule.outliers}}};
  for (const auto& [key, text] : statements) {
    const std::string where = fmt::format("/decision_rule/{}", key);
    if (!needed || !text.empty() || !findings.sound(where)) continue;
    findings.meaning(Code::kMissingKey, where,
                     fmt::format("this key is missing: ASME B89.7.3.1 requires its statement under "
                                 "the rule {}; write it in words",
                                 name_of(rule.rule)));
  }
}

void check_prior(const DecisionRuleTask& rule, Findings& findings) {
  constexpr std::string_view kWhere = "/decision_rule/prior/standard_deviation_um";
  if (!rule.prior || !findings.sound("/decision_rule/prior")) return;
  const record::PriorTask& prior = *rule.prior;
  if (prior.distribution == record::PriorTask::Distribution::kGamma &&
      prior.standard_deviation_um > prior.mean_um) {
    findings.meaning(Code::kMeaning, std::string(kWhere),
                     fmt::format("{} um is above the mean of {} um, and a gamma distribution would "
                                 "have no top; correct one of them, or give \"normal\"",
                                 plain(prior.standard_deviation_um), plain(prior.mean_um)));
  }
}

void check_rule(const DecisionRuleTask& rule, Findings& findings) {
  check_statements(rule, findings);
  check_prior(rule, findings);
  if (rule.rule == Rule::kGuardBand &&
      rule.acceptance_guard_percent + rule.rejection_guard_percent < 0.0) {
    findings.meaning(
        Code::kMeaning, "/decision_rule/rejection_guard_percent",
        fmt::format("guard bands of {} % and {} % leave values that would be accepted "
                    "and rejected; their sum must not be below 0",
                    plain(rule.acceptance_guard_percent), plain(rule.rejection_guard_percent)));
  }
  constexpr std::array<std::pair<std::string_view, Rule>, 6> kOwners = {
      {{"guard_factor", Rule::kIso14253},
       {"consumer_risk_percent", Rule::kJcgm106},
       {"producer_risk_percent", Rule::kJcgm106},
       {"ratio", Rule::kNToOne},
       {"acceptance_guard_percent", Rule::kGuardBand},
       {"rejection_guard_percent", Rule::kGuardBand}}};
  for (const auto& [key, owner] : kOwners) {
    const std::string where = fmt::format("/decision_rule/{}", key);
    if (rule.rule == owner || !findings.is_given(where) || !findings.sound(where)) continue;
    findings.meaning(Code::kMeaning, where,
                     fmt::format("this key belongs to the rule {} and has no effect under {}; take "
                                 "it out",
                                 name_of(owner), name_of(rule.rule)));
  }
}

bool any_terms(const record::MachineInfluencesTask& machine) {
  return !machine.translations.empty() || !machine.rotations.empty() ||
         machine.squareness_xy_urad + machine.squareness_xz_urad + machine.squareness_yz_urad > 0.0;
}

/// Checks that nothing is counted twice: limits of ISO 10360 include all errors of the machine or
/// the probe, so the single errors must not be given as well.
void check_limits(const record::UncertaintyTask& u, Findings& findings) {
  if (u.machine && u.machine->length_limit_um + u.machine->length_limit_um_m > 0.0 &&
      any_terms(*u.machine)) {
    findings.meaning(
        Code::kMeaning, "/uncertainty/machine",
        fmt::format("the length limit {} um + {} um/m (ISO 10360-2) contains the error "
                    "terms given beside it, and both would count; give the terms, or "
                    "the limit alone",
                    plain(u.machine->length_limit_um), plain(u.machine->length_limit_um_m)));
  }
  if (!u.probe || !(u.probe->form_limit_um > 0.0)) return;
  const bool touch = u.probe->repeatability_um.value_or(0.0) > 0.0;
  if (!touch && u.probe->lobes.empty()) return;
  findings.meaning(
      Code::kMeaning, "/uncertainty/probe/form_limit_um",
      fmt::format("{} um (ISO 10360-5) contains the {} given beside it, and both would "
                  "count; give these, or the limit alone",
                  plain(u.probe->form_limit_um), touch ? "repeatability" : "lobes"));
}

}  // namespace

void check_uncertainty(const Plan& plan, Findings& findings) {
  const DecisionRuleTask& rule = plan.decision_rule;
  if (!findings.sound("/decision_rule/rule")) return;
  check_rule(rule, findings);
  const bool needed = rule.rule != Rule::kSimpleAcceptance;
  if (needed && !findings.is_given("/uncertainty")) {
    findings.meaning(
        Code::kMissingKey, "/uncertainty",
        fmt::format("this key is missing: the rule {} needs the interval of the value; "
                    "declare what acts on the measurement",
                    name_of(rule.rule)));
  }
  if (!plan.uncertainty || !findings.sound("/uncertainty")) return;
  const record::UncertaintyTask& u = *plan.uncertainty;
  if (u.most_trials < u.least_trials) {
    findings.meaning(Code::kMeaning, "/uncertainty/most_trials",
                     fmt::format("{} is below least_trials {}", u.most_trials, u.least_trials));
  }
  check_limits(u, findings);
  if (needed && rule.measurand == DecisionRuleTask::Measurand::kWholeSurface && !u.form_spectrum) {
    findings.meaning(Code::kMissingKey, "/uncertainty/form_spectrum",
                     "this key is missing: a verdict about the whole surface needs the forms that "
                     "it may have between the points");
  }
  if (!u.form_spectrum) return;
  for (std::size_t i = 0; i < u.form_spectrum->terms.size(); ++i) {
    const record::FormTermTask& term = u.form_spectrum->terms[i];
    const std::string where = item_pointer("/uncertainty/form_spectrum/terms", i);
    if (term.undulations + term.degree == 0 || (term.undulations == 1 && term.degree < 2)) {
      findings.meaning(Code::kMeaning, where,
                       fmt::format("{} undulations of degree {} are size, place or tilt, not form; "
                                   "take the term out",
                                   term.undulations, term.degree));
    }
  }
}

}  // namespace rondure::plans
