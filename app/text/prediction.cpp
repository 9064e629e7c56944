#include "app/text/prediction.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/forecast.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/stated_value.h"

namespace rondure::app {
namespace {

using evaluation::Measurand;
using evaluation::PredictedStatement;
using nlohmann::ordered_json;

constexpr double kNormal95 = 1.96;  // half the width of 95 % of a normal distribution, in u

/// @param unit  Of the expected value; a size stands in mm, all else of the row in um.
std::string statement_row(const std::optional<PredictedStatement>& said, core::ValueUnit unit) {
  if (!said) return {};
  const int digits = evaluation::decimals_for(said->expanded_mm());
  return fmt::format("    {:<21} {:>11} {:>7.{}f} {:>7.{}f} {:>7.{}f} {:>7.{}f} {:>7.{}f}\n",
                     evaluation::name_of(said->measurand),
                     core::length_in(unit, said->expected_mm, digits) +
                         (unit == core::ValueUnit::kMm ? " mm" : ""),
                     core::micrometres(said->below_mm), digits, core::micrometres(said->above_mm),
                     digits, core::micrometres(said->width_mm()), digits,
                     core::micrometres(said->expanded_mm()), digits,
                     core::micrometres(said->nine_of_ten_expanded_mm()), digits);
}

std::string characteristic_rows(const plans::Plan& plan, const PredictedCharacteristic& of) {
  const evaluation::Prediction& p = of.prediction;
  const core::ValueUnit unit = evaluation::unit_of(of.characteristic);
  std::string out = fmt::format("  {}, {}\n", plan.features[of.feature].id, of.characteristic.id);
  out += statement_row(p.sampled, unit) + statement_row(p.whole, unit);
  if (p.budget.empty()) return out;  // trials of a part have none
  const Measurand widest = p.whole ? Measurand::kWholeSurface : Measurand::kSampledPoints;
  return out + wrapped(largest_influences(p, widest), "    from ", "      ");
}

/// Characteristics without an interval; those of a feature with the same reason are listed
/// together.
std::string rows_without(const plans::Plan& plan,
                         const std::vector<PredictedCharacteristic>& predicted) {
  std::string out;
  for (std::size_t i = 0; i < predicted.size();) {
    const PredictedCharacteristic& first = predicted[i];
    std::string names;
    for (; i < predicted.size() && predicted[i].feature == first.feature &&
           predicted[i].prediction.why == first.prediction.why;
         ++i) {
      names += (names.empty() ? "" : ", ") + predicted[i].characteristic.id;
    }
    if (first.prediction.why.empty() || first.residual) continue;
    out += wrapped(fmt::format("{}, {}: none; {}", plan.features[first.feature].id, names,
                               first.prediction.why),
                   "  ", "    ");
  }
  return out;
}

/// The assumptions, each once; where forms differ, with their characteristics.
std::string assumptions(const std::vector<PredictedCharacteristic>& predicted) {
  std::vector<std::pair<std::string, std::string>> forms;  // words, characteristics
  std::string repeatability;
  for (const PredictedCharacteristic& of : predicted) {
    const evaluation::Prediction& p = of.prediction;
    if (!of.states_surface()) continue;
    if (!p.repeatability.empty()) repeatability = p.repeatability;
    const auto same = std::find_if(forms.begin(), forms.end(),
                                   [&](const auto& form) { return form.first == p.form; });
    if (same == forms.end()) {
      forms.emplace_back(p.form, of.characteristic.id);
    } else {
      same->second += ", " + of.characteristic.id;
    }
  }
  std::string out;
  for (const auto& [words, characteristics] : forms) {
    const std::string whose = forms.size() > 1 ? fmt::format(" for {}", characteristics) : "";
    out += wrapped(fmt::format("Form of the parts{}: {}.", whose, words), "  ", "    ");
  }
  if (repeatability.empty()) return out;
  return out + wrapped(fmt::format("Repeatability of a touch: {}. "
                                   "uncertainty.probe.repeatability_um states it.",
                                   repeatability),
                       "  ", "    ");
}

/// Rows of one characteristic of an analysis.
std::string analysis_rows(const plans::Plan& plan, const PredictedCharacteristic& of) {
  const evaluation::AnalysisPrediction& p = *of.analysis;
  std::string out = fmt::format("  {}, {}\n", plan.features[of.feature].id, of.characteristic.id);
  const int digits = evaluation::decimals_for(p.expanded_mm());
  out += fmt::format("    {:<18} {:>11.{}f} {:>8.{}f} {:>8.{}f} {:>8.{}f} {:>8.{}f}\n",
                     p.at_most ? "at most" : "", core::micrometres(p.expected_mm), digits,
                     core::micrometres(p.below_mm), digits, core::micrometres(p.above_mm), digits,
                     core::micrometres(p.expanded_mm()), digits, core::micrometres(p.linear_u_mm),
                     std::min(digits + 1, 4));
  const std::string largest = largest_of(p.budget);
  return out + wrapped(largest.empty() ? "nothing: no influence is declared" : largest, "    from ",
                       "      ");
}

/// The predictions of analyses, with what they rest on.
std::string analysis_table(const plans::Plan& plan,
                           const std::vector<PredictedCharacteristic>& predicted) {
  std::string rows;
  const PredictedCharacteristic* first = nullptr;
  for (const PredictedCharacteristic& of : predicted) {
    if (!of.analysis) continue;
    if (first == nullptr) first = &of;
    rows += analysis_rows(plan, of);
  }
  if (first == nullptr) return {};
  return fmt::format("\nPredicted interval of analyses, before the first reading, {:.4g} %, um\n",
                     100.0 * first->analysis->coverage_1) +
         fmt::format("    {:<18} {:>11} {:>8} {:>8} {:>8} {:>8}\n", "", "expected", "-", "+", "U",
                     "u") +
         rows +
         wrapped(fmt::format("One set of data, simulated with the seed {} in place of {} and "
                             "evaluated as in a run: part, machine and scatter are those of "
                             "`simulation`. U is half the width of the interval, by trials; u is "
                             "the standard uncertainty by linear propagation of what the plan "
                             "declares. Nothing else is in them.",
                             first->simulated_seed, plan.simulation->seed),
                 "  ", "    ");
}

double residual_u_mm(const PredictedCharacteristic& of) {
  return of.characteristic.form == record::Form::kFixtureResidual ? of.residual->largest_u_mm
                                                                  : of.residual->rms_u_mm;
}

/// What is predicted of calibrations of the fixture: the uncertainty of values that cannot be
/// foretold.
std::string residual_table(const plans::Plan& plan,
                           const std::vector<PredictedCharacteristic>& predicted) {
  std::string rows;
  const PredictedCharacteristic* first = nullptr;
  for (const PredictedCharacteristic& of : predicted) {
    if (!of.residual) continue;
    if (first == nullptr) first = &of;
    const double u_um = core::micrometres(residual_u_mm(of));
    const bool largest = of.characteristic.form == record::Form::kFixtureResidual;
    rows +=
        wrapped(fmt::format("{}, {}: u {}{:.2g} um, U {}{:.2g} um", plan.features[of.feature].id,
                            of.characteristic.id, largest ? "at most " : "", u_um,
                            largest ? "at most " : "", kNormal95 * u_um),
                "  ", "    ");
  }
  if (first == nullptr) return {};
  const evaluation::ResidualPrediction& p = *first->residual;
  return "\nPredicted uncertainty of a calibration, before the first touch, 95 %\n" + rows +
         wrapped(
             fmt::format("Linear propagation to {} ball centres of {:.2g} um each: touches "
                         "(repeatability {}) and ball_um. U is {} u. The value itself cannot be "
                         "foretold: {}.",
                         p.centers, core::micrometres(p.center_u_mm), p.repeatability, kNormal95,
                         first->prediction.why),
             "  ", "    ");
}

bool states_any(const std::vector<PredictedCharacteristic>& predicted) {
  return std::any_of(predicted.begin(), predicted.end(),
                     [](const auto& of) { return of.states_surface(); });
}

/// The predictions of surfaces, at least one of which has an interval.
std::string surface_table(const plans::Plan& plan,
                          const std::vector<PredictedCharacteristic>& predicted) {
  const auto first = std::find_if(predicted.begin(), predicted.end(),
                                  [](const auto& of) { return of.states_surface(); });
  std::string out = fmt::format("\nPredicted interval, before the first touch, {:.4g} %, um\n",
                                100.0 * first->prediction.coverage_1);
  out += fmt::format("    {:<21} {:>11} {:>7} {:>7} {:>7} {:>7} {:>7}\n", "", "expected", "-", "+",
                     "width", "U", "U 9/10");
  for (const PredictedCharacteristic& of : predicted) {
    if (of.states_surface()) out += characteristic_rows(plan, of);
  }
  return out + assumptions(predicted) +
         wrapped(
             "U is half the width, the mean over such parts; nine of ten have at most U 9/10. "
             "Only what the plan declares is in it.",
             "  ", "    ");
}

std::string candidate_row(const SamplingCandidate& c, const SamplingSearch& of, bool best) {
  const Sampling& s = c.sampling;
  std::string layout = fmt::format("{} x {}", s.layers, s.points_per_layer);
  if (s == of.planned) layout += " (the plan)";
  if (!c.out_of_reach.empty()) {
    return fmt::format(
        "  {:<20} {:>7} {}\n", layout, s.repeats,
        c.missing.empty() ? "out of reach" : "without an interval that the plan has");
  }
  return fmt::format("  {:<20} {:>7} {:>8} {:>9} {:>8.3g} {:>8.3g}  {}\n", layout, s.repeats,
                     c.touches, clock_text(c.time_s), core::micrometres(c.expanded_mm),
                     core::micrometres(c.nine_of_ten_expanded_mm),
                     best ? "meets, cheapest" : (c.meets ? "meets" : "no"));
}

std::string advice(const SamplingSearch& of, double target_mm) {
  if (!of.best) {
    std::string text =
        fmt::format("No sampling that was tried meets {:.6g} um. What limits the smallest U",
                    core::micrometres(target_mm));
    text += of.limit.empty() ? ": nothing that is declared." : ": " + of.limit + ".";
    return wrapped(text, "  ", "  ");
  }
  const auto changes = changes_of(of);
  if (changes.empty()) return "  The plan as it stands is the cheapest that meets it.\n";
  std::string out = "  To change in the plan (JSON pointer, keys to set):\n";
  for (std::size_t i = 0; i < changes.size();) {
    const std::string& object = changes[i].object;
    std::string values;
    for (; i < changes.size() && changes[i].object == object; ++i) {
      values +=
          fmt::format("{}\"{}\": {}", values.empty() ? "" : ", ", changes[i].key, changes[i].value);
    }
    out += fmt::format("    {}  {{{}}}\n", object, values);
  }
  return out;
}

/// The features that are analyses: their data are no sampling of a surface.
std::vector<std::string> analyses_of(const plans::Plan& plan) {
  std::vector<std::string> out;
  for (const plans::FeaturePlan& feature : plan.features) {
    if (record::is_analysis(feature.type)) out.push_back(feature.id);
  }
  return out;
}

/// That no samplings of analyses are searched; empty for a plan without any.
std::string analyses_not_searched(const plans::Plan& plan) {
  const std::vector<std::string> ids = analyses_of(plan);
  if (ids.empty()) return {};
  return wrapped(fmt::format("--target-U proposes samplings of touched surfaces only, and none for "
                             "{}.",
                             fmt::join(ids, ", ")),
                 "  ", "  ");
}

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

/// The keys of the prediction of an analysis.
void add_analysis(const PredictedCharacteristic& of, ordered_json& out) {
  const evaluation::AnalysisPrediction& p = *of.analysis;
  out["coverage"] = p.coverage_1;
  out["from"] = "one simulated set of data";
  out["simulated_seed"] = of.simulated_seed;
  out["as_read_um"] = core::micrometres(p.as_read_mm);
  out["expected_um"] = core::micrometres(p.expected_mm);
  out["at_most"] = p.at_most;
  out["below_um"] = core::micrometres(p.below_mm);
  out["above_um"] = core::micrometres(p.above_mm);
  out["expanded_um"] = core::micrometres(p.expanded_mm());
  out["linear_standard_uncertainty_um"] = core::micrometres(p.linear_u_mm);
  out["budget"] = ordered_json::array();
  for (const auto& line : p.budget) out["budget"].push_back(budget_json(line));
}

/// The keys of the prediction of a calibration.
void add_residual(const PredictedCharacteristic& of, ordered_json& out) {
  const double u_um = core::micrometres(residual_u_mm(of));
  out["coverage"] = 0.95;
  out["from"] = "linear propagation";
  out["value_not_foretold"] = of.prediction.why;
  out["at_most"] = of.characteristic.form == record::Form::kFixtureResidual;
  out["expanded_um"] = kNormal95 * u_um;
  out["linear_standard_uncertainty_um"] = u_um;
  out["ball_centers"] = of.residual->centers;
  out["ball_center_standard_uncertainty_um"] = core::micrometres(of.residual->center_u_mm);
  out["repeatability"] = of.residual->repeatability;
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

std::string prediction_table(const plans::Plan& plan,
                             const std::vector<PredictedCharacteristic>& predicted) {
  if (predicted.empty()) return {};
  std::string out;
  if (states_any(predicted)) out += surface_table(plan, predicted);
  out += analysis_table(plan, predicted);
  out += residual_table(plan, predicted);
  if (out.empty()) out += "\nPredicted interval, before the first touch: none\n";
  return out + rows_without(plan, predicted);
}

std::string search_table(const plans::Plan& plan, const std::vector<SamplingSearch>& searches,
                         double target_mm) {
  const std::string not_searched = analyses_not_searched(plan);
  if (searches.empty()) {
    return "\nNo feature is touched, so no sampling can be proposed.\n" + not_searched;
  }
  std::string out;
  for (const SamplingSearch& of : searches) {
    out += fmt::format("\nSamplings of {} for U of at most {:.6g} um {}\n",
                       plan.features[of.feature].id, core::micrometres(target_mm),
                       evaluation::name_of(of.measurand));
    if (!of.why.empty()) {
      out += wrapped("none: " + of.why, "  ", "  ");
      continue;
    }
    out += fmt::format("  {:<20} {:>7} {:>8} {:>9} {:>8} {:>8}\n", "layers x points", "repeats",
                       "touches", "min:s", "U um", "U 9/10");
    for (std::size_t k = 0; k < of.candidates.size(); ++k) {
      out += candidate_row(of.candidates[k], of, of.best == k);
    }
    out +=
        "  Touches and time are those of the whole run; a sampling meets the target when\n"
        "  U 9/10 does: the U that nine of ten parts stay below.\n";
    out += advice(of, target_mm);
  }
  if (!not_searched.empty()) out += "\n" + not_searched;
  return out;
}

ordered_json prediction_json(const plans::Plan& plan,
                             const std::vector<PredictedCharacteristic>& predicted) {
  ordered_json out = ordered_json::array();
  for (const PredictedCharacteristic& of : predicted) {
    const evaluation::Prediction& p = of.prediction;
    ordered_json one = {{"feature", plan.features[of.feature].id},
                        {"characteristic", of.characteristic.id}};
    if (of.analysis) {
      add_analysis(of, one);
    } else if (of.residual) {
      add_residual(of, one);
    } else if (!p.why.empty()) {
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
  return {{"expanded_um", core::micrometres(target_mm)},
          {"features", features},
          {"not_searched", analyses_of(plan)}};
}

}  // namespace rondure::app
