#include "app/prediction/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/units.h"

namespace rondure::app {
namespace {

using evaluation::PredictedStatement;
using nlohmann::ordered_json;

ordered_json statement_json(const std::optional<PredictedStatement>& said) {
  if (!said) return nullptr;
  return {{"expected_um", core::micrometres(said->expected_mm)},
          {"below_um", core::micrometres(said->below_mm)},
          {"above_um", core::micrometres(said->above_mm)},
          {"width_um", core::micrometres(said->width_mm())},
          {"expanded_um", core::micrometres(said->expanded_mm())},
          {"nine_of_ten_expanded_um", core::micrometres(said->nine_of_ten_expanded_mm())}};
}

ordered_json budget_json(const evaluation::BudgetLine& line) {
  return {{"name", line.name},
          {"measurand", evaluation::name_of(line.measurand)},
          {"standard_uncertainty_um", core::micrometres(line.standard_uncertainty_mm)},
          {"shift_um", core::micrometres(line.shift_mm)},
          {"share", line.share_1}};
}

ordered_json candidate_json(const SamplingCandidate& c) {
  ordered_json out = {{"layers", c.sampling.layers},
                      {"points_per_layer", c.sampling.points_per_layer},
                      {"repeats", c.sampling.repeats}};
  if (!c.out_of_reach.empty()) {
    out["out_of_reach"] = c.out_of_reach;
    return out;
  }
  out["touches"] = c.touches;
  out["time_s"] = c.time_s;
  out["expanded_um"] = core::micrometres(c.expanded_mm);
  out["nine_of_ten_expanded_um"] = core::micrometres(c.nine_of_ten_expanded_mm);
  out["meets"] = c.meets;
  return out;
}

ordered_json changes_json(const SamplingSearch& of) {
  ordered_json out = ordered_json::array();
  for (const SamplingChange& change : changes_of(of)) {
    out.push_back({{"pointer", change.object + "/" + change.key}, {"value", change.value}});
  }
  return out;
}

}  // namespace

ordered_json prediction_json(const plans::Plan& plan,
                             const std::vector<PredictedCharacteristic>& predicted) {
  ordered_json out = ordered_json::array();
  for (const PredictedCharacteristic& of : predicted) {
    const evaluation::Prediction& p = of.prediction;
    ordered_json one = {{"feature", plan.features[of.feature].id},
                        {"characteristic", of.characteristic.id}};
    if (!p.why.empty()) {
      one["none"] = p.why;
    } else {
      one["coverage"] = p.coverage_1;
      one["sampled_points"] = statement_json(p.sampled);
      one["whole_surface"] = statement_json(p.whole);
      one["form"] = p.form;
      one["repeatability"] = p.repeatability.empty() ? "as declared" : p.repeatability;
      one["budget"] = ordered_json::array();
      for (const auto& line : p.budget) one["budget"].push_back(budget_json(line));
    }
    out.push_back(std::move(one));
  }
  return out;
}

ordered_json search_json(const plans::Plan& plan, const std::vector<SamplingSearch>& searches,
                         double target_mm) {
  ordered_json features = ordered_json::array();
  for (const SamplingSearch& of : searches) {
    ordered_json one = {{"feature", plan.features[of.feature].id},
                        {"measurand", evaluation::name_of(of.measurand)},
                        {"met", of.best.has_value()}};
    if (!of.why.empty()) one["none"] = of.why;
    if (!of.limit.empty()) one["limit"] = of.limit;
    one["changes"] = changes_json(of);
    one["best"] = of.best ? candidate_json(of.candidates[*of.best]) : ordered_json(nullptr);
    one["candidates"] = ordered_json::array();
    for (const auto& c : of.candidates) one["candidates"].push_back(candidate_json(c));
    features.push_back(std::move(one));
  }
  return {{"expanded_um", core::micrometres(target_mm)}, {"features", features}};
}

}  // namespace rondure::app
