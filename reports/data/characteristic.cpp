#include <string_view>

#include "core/numbers.h"
#include "evaluation/part/find.h"
#include "evaluation/results/feature_values.h"
#include "record/tasks/settings.h"
#include "reports/data/internal/json_parts.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

Json statement_json(const evaluation::UncertaintyStatement& s) {
  return {{"estimate_um", in_um(s.estimate_mm)},
          {"low_um", in_um(s.low_mm)},
          {"high_um", in_um(s.high_mm)},
          {"standard_uncertainty_um", in_um(s.standard_uncertainty_mm)},
          {"expanded_um", in_um(s.expanded_mm())},
          {"numerical_tolerance_um", in_um(s.numerical_tolerance_mm)},
          {"at_most", s.at_most}};
}

Json form_json(const evaluation::FormFinding& finding) {
  return {{"noise_um", in_um(finding.noise_mm)},
          {"unresolved_um", in_um(finding.unresolved_mm)},
          {"groups", finding.groups},
          {"spots", finding.spots},
          {"spot_rows", finding.spot_rows}};
}

Json budget_json(const evaluation::BudgetLine& line) {
  return {{"name", line.name},
          {"measurand", name_of(line.measurand)},
          {"standard_uncertainty_um", in_um(line.standard_uncertainty_mm)},
          {"shift_um", line.per_u_mm ? Json(nullptr) : Json(in_um(line.shift_mm))},
          {"per_u_um", line.per_u_mm ? Json(in_um(*line.per_u_mm)) : Json(nullptr)},
          {"share", line.share_1}};
}

Json influence_json(const evaluation::InfluenceStatement& influence) {
  return {{"name", influence.name}, {"covered", influence.covered}, {"text", influence.text}};
}

Json prior_json(const std::optional<evaluation::Prior>& prior) {
  if (!prior) return nullptr;
  return {{"distribution", name_of(prior->kind)},
          {"mean_um", in_um(prior->mean_mm)},
          {"standard_deviation_um", in_um(prior->standard_deviation_mm)}};
}

/// Intervals, bias, budget and declaration of a value; null without an interval.
/// @param of_cloud  Whether the form model of the trials saw a cloud: an analysis has none.
Json uncertainty_json(bool of_cloud, const evaluation::CharacteristicResult& result) {
  if (!result.value || !result.value->uncertainty().result()) return nullptr;
  const evaluation::UncertaintyResult& u = *result.value->uncertainty().result();
  return {{"coverage", result.value->uncertainty().coverage_1()},
          {"sampled_points", statement_json(u.sampled)},
          {"whole_surface", u.whole ? statement_json(*u.whole) : Json(nullptr)},
          {"noise_inflation_um", in_um(u.noise_inflation_mm)},
          {"sampling_loss_um", optional_um(u.sampling_loss_mm)},
          {"form_spectrum", u.spectrum_source},
          {"finding", of_cloud ? form_json(u.finding) : Json(nullptr)},
          {"notes", u.notes},
          {"trials", u.trials},
          {"tolerance_reached", u.tolerance_reached},
          {"budget", list_json(u.budget, budget_json)},
          {"influences", list_json(u.declaration, influence_json)}};
}

/// A limit in um. That of a form without filter and window keeps the digits of earlier versions,
/// which journals hold.
/// @param found  Whether evaluation::find() computes the value.
Json limit_um(bool found, const std::optional<double>& limit_mm) {
  return found ? optional_json(limit_in(core::ValueUnit::kUm, limit_mm)) : optional_um(limit_mm);
}

/// The compared value, the limits of the rule and the risks; null where the rule decided nothing.
Json decision_json(bool found, const evaluation::CharacteristicResult& result) {
  if (!result.outcome) return nullptr;
  const evaluation::RuleOutcome& o = *result.outcome;
  const auto& risks = result.risks;
  Json json = {{"compared_um", in_um(o.compared_mm)},
               {"acceptance_limit_um", limit_um(found, o.acceptance.upper_mm)},
               {"rejection_limit_um", limit_um(found, o.rejection.upper_mm)},
               {"conformance_probability", optional_json(o.conformance_1)},
               {"specific_risk", optional_json(o.specific_risk_1())},
               {"global_consumer_risk", risks ? Json(risks->false_acceptance_1) : Json(nullptr)},
               {"global_producer_risk", risks ? Json(risks->false_rejection_1) : Json(nullptr)}};
  if (o.acceptance.lower_mm || o.rejection.lower_mm) {
    json["lower_acceptance_limit_um"] = limit_um(found, o.acceptance.lower_mm);
    json["lower_rejection_limit_um"] = limit_um(found, o.rejection.lower_mm);
  }
  return json;
}

/// The same object of an angle: every key of a number in um ends in _urad instead.
Json of_angle(const Json& json) {
  constexpr std::string_view kUm = "_um";
  if (json.is_array()) return list_json(json, of_angle);
  if (!json.is_object()) return json;
  Json out = Json::object();
  for (const auto& [key, value] : json.items()) {
    const bool number = key.ends_with(kUm);
    out[number ? key.substr(0, key.size() - kUm.size()) + "_urad" : key] = of_angle(value);
  }
  return out;
}

/// A rule as the plan spells it.
Json own_rule_json(const record::DecisionRuleTask& rule) {
  Json json = Json::object();
  for (const record::Setting& setting : record::settings_of_task(rule)) {
    json[setting.name] = setting.number ? Json(*setting.number) : Json(setting.text);
  }
  return json;
}

/// Adds what a drawing can ask beside form, reference and one limit; nothing where it asks no more.
void add_indication(const evaluation::CharacteristicResult& result, Json& json) {
  using Filter = record::Indication::Filter;
  const record::Characteristic& asked = result.characteristic;
  const record::Indication& indication = asked.indication;
  if (const auto unit = evaluation::unit_of(asked); unit == core::ValueUnit::kMm) {
    json["unit"] = name_of(unit);
    json["tolerance_um"] = nullptr;
    json["lower_limit_mm"] = optional_json(limit_in(unit, asked.lower_mm));
    json["upper_limit_mm"] = optional_json(limit_in(unit, asked.tolerance_mm));
  } else if (asked.lower_mm) {
    json["tolerance_um"] = nullptr;
    json["lower_limit_um"] = optional_json(limit_in(unit, asked.lower_mm));
    json["upper_limit_um"] = optional_json(limit_in(unit, asked.tolerance_mm));
  }
  if (!indication.datum.empty()) json["datum"] = indication.datum;
  if (const Filter filter = indication.filter.value_or(Filter::kNone); filter != Filter::kNone) {
    json["filter"] = {{"name", record::name_of(filter)},
                      {"cutoff_upr", optional_json(indication.cutoff_upr)},
                      {"cutoff_mm", optional_json(indication.cutoff_mm)}};
  }
  if (indication.decision_rule) json["decision_rule"] = own_rule_json(*indication.decision_rule);
  if (result.finding) json["finding"] = finding_json(*result.finding, evaluation::unit_of(asked));
}

Json truth_json(const HeldAgainstTruth& one) {
  return {{"name", one.name},
          {"found_um", in_um(one.found_mm())},
          {"truth_um", in_um(one.truth_mm)},
          {"difference_um", in_um(one.difference_mm())},
          {"difference_over_u", optional_json(one.difference_over_u())}};
}

Json characteristic_json(const record::Feature& feature,
                         const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  const bool found = evaluation::is_found(feature, asked);
  Json json = {{"id", asked.id},
               {"form", record::name_of(asked.form)},
               {"symbol", evaluation::symbol_of(asked)},
               {"reference", evaluation::reference_of(asked)},
               {"value_um", optional_um(result.value_mm())},
               {"quoted_um", result.value && !is_bound(*result.value)
                                 ? Json(in_um(result.value->quoted_mm()))
                                 : Json(nullptr)},
               {"tolerance_um", limit_um(found, asked.tolerance_mm)},
               {"verdict", name_of(result.verdict)},
               {"reason", result.reason},
               {"operator", result.value ? Json(result.value->operator_text()) : Json(nullptr)},
               {"drawing_zone", asked.drawing_zone},
               {"stated", result.value ? Json(result.value->sentence()) : Json(nullptr)},
               {"uncertainty", uncertainty_json(!record::is_analysis(feature.shape), result)},
               {"no_uncertainty_because", result.value && !result.value->uncertainty().result()
                                              ? Json(result.value->uncertainty().why())
                                              : Json(nullptr)},
               {"decision", decision_json(found, result)}};
  add_indication(result, json);
  const auto truths = held_against_truth(result);
  if (!truths.empty()) json["simulation"] = list_json(truths, truth_json);
  if (evaluation::unit_of(asked) != core::ValueUnit::kUrad) return json;
  json["unit"] = name_of(core::ValueUnit::kUrad);
  return of_angle(json);
}

}  // namespace

Json characteristics_json(const evaluation::FeatureResult& feature) {
  return list_json(feature.characteristics, [&](const auto& result) {
    return characteristic_json(feature.feature, result);
  });
}

Json rule_json(const evaluation::Evaluation& evaluation) {
  if (!evaluation.rule) return nullptr;
  const evaluation::DecisionRule& rule = *evaluation.rule;
  return {{"rule", name_of(rule.kind)},
          {"words", in_words(rule)},
          {"measurand", name_of(rule.measurand)},
          {"prior", prior_json(rule.prior)},
          {"zones", rule.zones},
          {"outcomes", rule.outcomes},
          {"repeats", rule.repeats},
          {"outliers", rule.outliers}};
}

}  // namespace rondure::reports
