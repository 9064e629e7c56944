#include "app/text/prediction.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/text/forecast.h"
#include "core/units.h"
#include "evaluation/results/stated_value.h"

namespace rondure::app {
namespace {

using evaluation::Measurand;
using evaluation::PredictedStatement;

/// Breaks a sentence into lines of 78 columns at most, all but the first indented.
std::string wrapped(const std::string& text, const std::string& first, const std::string& indent) {
  constexpr std::size_t kColumns = 78;
  std::string out;
  std::string line = first;
  bool begun = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (begun && line.size() + 1 + word.size() > kColumns) {
      out += line + "\n";
      line = indent;
      begun = false;
    }
    line += (begun ? " " : "") + word;
    begun = true;
    at = end + 1;
  }
  return out + line + "\n";
}

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

/// Characteristics without an interval: those of a feature that share a reason, together.
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

/// What was assumed, each thing once; of forms that differ, for what.
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

}  // namespace rondure::app
