#include "app/text/prediction.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/forecast.h"
#include "core/units.h"
#include "evaluation/results/stated_value.h"

namespace rondure::app {
namespace {

using evaluation::Measurand;
using evaluation::PredictedStatement;
using nlohmann::ordered_json;

std::string statement_row(const std::optional<PredictedStatement>& said) {
  if (!said) return {};
  const int digits = evaluation::decimals_for(said->expanded_mm());
  return fmt::format("    {:<24} {:>8.{}f} {:>7.{}f} {:>7.{}f} {:>7.{}f} {:>7.{}f} {:>7.{}f}\n",
                     evaluation::name_of(said->measurand), core::micrometres(said->expected_mm),
                     digits, core::micrometres(said->below_mm), digits,
                     core::micrometres(said->above_mm), digits, core::micrometres(said->width_mm()),
                     digits, core::micrometres(said->expanded_mm()), digits,
                     core::micrometres(said->nine_of_ten_expanded_mm()), digits);
}

std::string characteristic_rows(const plans::Plan& plan, const PredictedCharacteristic& of) {
  const evaluation::Prediction& p = of.prediction;
  std::string out = fmt::format("  {}, {}\n", plan.features[of.feature].id, of.characteristic.id);
  out += statement_row(p.sampled) + statement_row(p.whole);
  const Measurand widest = p.whole ? Measurand::kWholeSurface : Measurand::kSampledPoints;
  const std::string largest = largest_influences(p, widest);
  return out + wrapped(largest.empty() ? "nothing: no influence is declared" : largest, "    from ",
                       "      ");
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
    if (first.prediction.why.empty()) continue;
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
    if (!p.why.empty()) continue;
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

bool states_any(const std::vector<PredictedCharacteristic>& predicted) {
  return std::any_of(predicted.begin(), predicted.end(),
                     [](const auto& of) { return of.prediction.why.empty(); });
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

std::string prediction_table(const plans::Plan& plan,
                             const std::vector<PredictedCharacteristic>& predicted) {
  if (predicted.empty()) return {};
  std::string out = "\nPredicted interval, before the first touch";
  if (!states_any(predicted)) {
    out += ": none\n";
  } else {
    const auto first = std::find_if(predicted.begin(), predicted.end(),
                                    [](const auto& of) { return of.prediction.why.empty(); });
    out += fmt::format(", {:.4g} %, um\n", 100.0 * first->prediction.coverage_1);
    out += fmt::format("    {:<24} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7}\n", "", "expected", "-", "+",
                       "width", "U", "U 9/10");
  }
  for (const PredictedCharacteristic& of : predicted) {
    if (of.prediction.why.empty()) out += characteristic_rows(plan, of);
  }
  out += rows_without(plan, predicted);
  out += assumptions(predicted);
  if (!states_any(predicted)) return out;
  return out +
         wrapped(
             "U is half the width, the mean over such parts; nine of ten have at most U 9/10. "
             "Only what the plan declares is in it.",
             "  ", "    ");
}

std::string search_table(const plans::Plan& plan, const std::vector<SamplingSearch>& searches,
                         double target_mm) {
  if (searches.empty()) return "\nNo feature is touched, so no sampling can be proposed.\n";
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
  return out;
}

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
