#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::DecisionRuleTask;
using Rule = DecisionRuleTask::Rule;

/// Checks the four statements of ASME B89.7.3.1: needed by its rules, without effect under others.
void check_statements(const DecisionRuleTask& rule, const std::string& place, Findings& findings) {
  const bool needed = rule.rule == Rule::kNToOne || rule.rule == Rule::kGuardBand;
  const std::array<std::pair<std::string_view, std::string_view>, 4> statements = {
      {{"zones", rule.zones},
       {"outcomes", rule.outcomes},
       {"repeats", rule.repeats},
       {"outliers", rule.outliers}}};
  for (const auto& [key, text] : statements) {
    const std::string where = member_pointer(place, key);
    if (!needed || !text.empty() || !findings.sound(where)) continue;
    findings.meaning(Code::kMissingKey, where,
                     fmt::format("this key is missing: ASME B89.7.3.1 requires its statement under "
                                 "the rule {}; write it in words",
                                 name_of(rule.rule)));
  }
}

void check_prior(const DecisionRuleTask& rule, const std::string& place, Findings& findings) {
  if (!rule.prior || !findings.sound(place + "/prior")) return;
  const record::PriorTask& prior = *rule.prior;
  if (prior.distribution == record::PriorTask::Distribution::kGamma &&
      prior.standard_deviation_um > prior.mean_um) {
    findings.meaning(Code::kMeaning, place + "/prior/standard_deviation_um",
                     fmt::format("{} um is above the mean of {} um, and a gamma distribution would "
                                 "have no top; correct one of them, or give \"normal\"",
                                 plain(prior.standard_deviation_um), plain(prior.mean_um)));
  }
}

void check_rule(const DecisionRuleTask& rule, const std::string& place, Findings& findings) {
  check_statements(rule, place, findings);
  check_prior(rule, place, findings);
  if (rule.rule == Rule::kGuardBand &&
      rule.acceptance_guard_percent + rule.rejection_guard_percent < 0.0) {
    findings.meaning(
        Code::kMeaning, place + "/rejection_guard_percent",
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
    const std::string where = member_pointer(place, key);
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

/// Refuses entries of a list that declare the same thing as an earlier one: both would be drawn, in
/// a time that grows with the cube of their number.
/// @param key_of   What an entry declares.
/// @param in_words The same for the message, of an entry.
template <class List, class KeyOf, class InWords>
void check_once(const List& list, const std::string& where, const KeyOf& key_of,
                const InWords& in_words, Findings& findings) {
  std::set<decltype(key_of(list.front()))> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (seen.insert(key_of(list[i])).second) continue;
    findings.meaning(Code::kMeaning, item_pointer(where, i),
                     fmt::format("{} stand here already; declare them once, with the size of all",
                                 in_words(list[i])));
  }
}

void check_each_once(const record::UncertaintyTask& u, Findings& findings) {
  if (u.probe) {
    check_once(
        u.probe->lobes, "/uncertainty/probe/lobes", [](const auto& lobe) { return lobe.order; },
        [](const auto& lobe) { return fmt::format("{} lobes", lobe.order); }, findings);
  }
  if (!u.form_spectrum) return;
  check_once(
      u.form_spectrum->terms, "/uncertainty/form_spectrum/terms",
      [](const auto& term) { return std::pair(term.undulations, term.degree); },
      [](const auto& term) {
        return fmt::format("{} undulations of degree {}", term.undulations, term.degree);
      },
      findings);
}

/// A rule of the plan, of a feature or of a characteristic.
struct PlacedRule {
  const DecisionRuleTask* rule = nullptr;
  std::string where;
  /// Whether it can judge a surface; analyses declare what acts on them in their own section.
  bool of_surface = true;
};

std::vector<PlacedRule> rules_of(const Plan& plan) {
  const auto is_surface = [](const FeaturePlan& feature) {
    return analysis_kind(feature.type) == nullptr;
  };
  const bool any =
      plan.features.empty() || std::any_of(plan.features.begin(), plan.features.end(), is_surface);
  std::vector<PlacedRule> out = {{&plan.decision_rule, "/decision_rule", any}};
  bool surface = true;
  const auto add = [&](const std::optional<DecisionRuleTask>& rule, const std::string& where) {
    if (rule) out.push_back({&*rule, where + "/decision_rule", surface});
  };
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    const std::string where = feature_pointer(i);
    surface = is_surface(feature);
    add(feature.decision_rule, where);
    for (std::size_t k = 0; k < feature.characteristics.size(); ++k) {
      add(feature.characteristics[k].indication.decision_rule,
          item_pointer(where + "/characteristics", k));
    }
  }
  return out;
}

}  // namespace

void check_uncertainty(const Plan& plan, Findings& findings) {
  const DecisionRuleTask* needing = nullptr;  // the first rule that needs intervals
  bool whole_surface = false;
  for (const PlacedRule& placed : rules_of(plan)) {
    const DecisionRuleTask& rule = *placed.rule;
    if (!findings.sound(placed.where + "/rule")) return;
    check_rule(rule, placed.where, findings);
    if (rule.rule == Rule::kSimpleAcceptance || !placed.of_surface) continue;
    if (needing == nullptr) needing = &rule;
    whole_surface = whole_surface || rule.measurand == DecisionRuleTask::Measurand::kWholeSurface;
  }
  if (needing != nullptr && !findings.is_given("/uncertainty")) {
    findings.meaning(
        Code::kMissingKey, "/uncertainty",
        fmt::format("this key is missing: the rule {} needs the interval of the value; "
                    "declare what acts on the measurement",
                    name_of(needing->rule)));
  }
  if (!plan.uncertainty || !findings.sound("/uncertainty")) return;
  const record::UncertaintyTask& u = *plan.uncertainty;
  if (u.most_trials < u.least_trials) {
    findings.meaning(Code::kMeaning, "/uncertainty/most_trials",
                     fmt::format("{} is below least_trials {}", u.most_trials, u.least_trials));
  }
  check_limits(u, findings);
  check_each_once(u, findings);
  if (whole_surface && !u.form_spectrum) {
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
