#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::signed_um;
using core::tiny_um;
using core::um;

/// Meaning of the letters in the formula of the rule.
constexpr const char* kFormulaLetters = translatable(
    "T: the tolerance; y: the value corrected for noise (and, of the whole surface, for sparse "
    "sampling); [lo, hi]: its coverage interval; U: half its width. In the bars above: the line is "
    "T, "
    "the shaded band about it the guard bands, the whisker the interval.");

std::string statements(const evaluation::DecisionRule& rule) {
  std::string html;
  const auto add = [&](const std::string& name, const std::string& text) {
    if (!text.empty()) html += entry(name, isolated(text));
  };
  add(tr("Zones"), rule.zones);
  add(tr("Outcomes"), rule.outcomes);
  add(tr("Repeated measurements"), rule.repeats);
  add(tr("Outliers"), rule.outliers);
  return html.empty() ? html : "<dl>" + html + "</dl>";
}

/// @param unit      Of the value; the uncertainty of a length is always in µm.
/// @param at_least  Only the lower end is known.
std::string statement_entry(const std::string& name, const evaluation::UncertaintyStatement& s,
                            core::ValueUnit unit, double coverage_1, bool at_least) {
  const int decimals = evaluation::decimals_for(s.expanded_mm());
  const auto number = [&](double mm) { return fixed(mm * 1e3, decimals); };
  const auto value = [&](double mm) {
    return unit == core::ValueUnit::kMm ? core::length_in(unit, mm, decimals) : number(mm);
  };
  const std::string_view sign = core::sign_of(unit);
  const auto with_small_sign = [&](const std::string& text) {
    return fmt::format("{} {}", text, core::sign_of(core::unit_of_difference(unit)));
  };
  if (s.at_most || at_least) {
    const std::string stable = with_small_sign(tiny_um(s.numerical_tolerance_mm));
    return entry(
        name,
        with_note(fmt::format("{} {} {}", s.at_most ? "≤" : "≥",
                              value(s.at_most ? s.high_mm : s.low_mm), sign),
                  s.at_most
                      ? trf("upper end of the {:g} % interval; noise and influences make up too "
                            "much of the value for more. Numbers stable to {}",
                            100.0 * coverage_1, stable)
                      : trf("lower end of the {:g} % interval; the points may miss more of the "
                            "value. Numbers stable to {}",
                            100.0 * coverage_1, stable)),
        "lead");
  }
  return entry(name,
               with_note(fmt::format("{} {} [{}, {}]", value(s.estimate_mm), sign, value(s.low_mm),
                                     value(s.high_mm)),
                         trf("corrected value; {:g} % interval, U = {}, standard uncertainty {}; "
                             "numbers stable to {}",
                             100.0 * coverage_1, with_small_sign(number(s.expanded_mm())),
                             with_small_sign(fixed(s.standard_uncertainty_mm * 1e3, decimals + 1)),
                             with_small_sign(tiny_um(s.numerical_tolerance_mm)))),
               "lead");
}

std::string bias_entries(const evaluation::UncertaintyResult& u) {
  std::string html =
      entry(tr("Bias by noise"), with_note(signed_um(u.noise_inflation_mm) + " µm",
                                           tr("expected inflation: measured minus free of noise, "
                                              "at the sampled points")));
  html += u.sampling_loss_mm
              ? entry(tr("Bias by sparse sampling"),
                      with_note(signed_um(*u.sampling_loss_mm) + " µm",
                                tr("expected loss: at the sampled points minus of the whole "
                                   "surface")))
              : entry(tr("Bias by sparse sampling"),
                      with_note(tr("not stated"),
                                tr("no form spectrum was declared: nothing is said of the surface "
                                   "between the points")));
  return html;
}

/// Findings of the form model in the cloud.
std::string finding_entry(const evaluation::UncertaintyResult& u) {
  const evaluation::FormFinding& found = u.finding;
  std::string note = tr("means over the draws; spots are form and are never smoothed away");
  if (!found.spot_rows.empty()) {
    std::string rows;
    for (const std::size_t row : found.spot_rows) {
      rows += fmt::format("{}{}", rows.empty() ? "" : ", ", row + 1);
    }
    note += trf("; spots at points {}", rows);
  }
  for (const core::Phrase& said : u.notes) note += "; " + in_sentence(said);
  return entry(tr("Made of"),
               with_note(trf("noise {} µm a point, rougher form {} µm, {} undulations, {} spots",
                             fixed(1e3 * found.noise_mm, 3), fixed(1e3 * found.unresolved_mm, 3),
                             fixed(found.groups, 1), fixed(found.spots, 1)),
                         note),
               "wide-key");
}

/// Notes of an interval that has no form model beside which they could stand.
std::string note_list(const std::vector<core::Phrase>& notes) {
  std::string html;
  for (const core::Phrase& said : notes) html += note(opening_sentence(said));
  return html;
}

std::string declaration(const std::vector<evaluation::InfluenceStatement>& influences) {
  TableRows rows;
  for (const bool covered : {true, false}) {
    for (const evaluation::InfluenceStatement& influence : influences) {
      if (influence.covered != covered) continue;
      rows.push_back({worded(core::Phrase(influence.name)),
                      covered ? tr("covered") : fmt::format("<b>{}</b>", tr("not covered")),
                      in_sentence(influence.text)});
    }
  }
  return table("short", "lll", spoken_caption(tr("Influence")),
               {tr("Influence"), tr("In the interval"), tr("As declared")}, rows);
}

/// @param of_cloud  Whether the value is one of touches and points, whose form the trials draw.
std::string value_part(const evaluation::CharacteristicResult& result, bool of_cloud) {
  const evaluation::UncertaintyStatus& status = result.value->uncertainty();
  const evaluation::UncertaintyResult& u = *status.result();
  std::string html = fmt::format(R"(<h3>{}</h3><p class="note">{}</p>)",
                                 trf("Uncertainty of {}", isolated(result.characteristic.id)),
                                 trf("{}. Monte Carlo of {} trials (JCGM 101).",
                                     in_sentence(result.value->sentence()), u.trials));
  html += R"(<dl class="keys">)";
  const core::ValueUnit unit = result.value->unit();
  const bool at_least = result.value->bound() == evaluation::StatedValue::Bound::kLower;
  html += entry(tr("As read, not corrected"),
                fmt::format("{} {}",
                            unit == core::ValueUnit::kMm ? result.value->in_digits(u.uncorrected_mm)
                                                         : um(u.uncorrected_mm),
                            core::sign_of(unit)));
  html += statement_entry(
      of_cloud ? tr("At the sampled points, free of noise") : tr("Free of noise and influences"),
      u.sampled, unit, status.coverage_1(), at_least);
  if (u.whole) {
    html +=
        statement_entry(tr("Of the whole surface"), *u.whole, unit, status.coverage_1(), at_least);
    html += entry(tr("Form spectrum of it"), in_sentence(u.spectrum_source), "wide-key");
  }
  html += of_cloud ? bias_entries(u) + finding_entry(u)
                   : entry(tr("Inflation by noise and influences"),
                           with_note(fmt::format("{} {}", signed_um(u.noise_inflation_mm),
                                                 core::sign_of(core::unit_of_difference(unit))),
                                     tr("value as measured minus the corrected value")));
  html += "</dl>";
  if (!of_cloud) html += note_list(u.notes);
  if (const std::string bars = budget_bars(u.budget, core::unit_of_difference(unit));
      !bars.empty()) {
    html += fmt::format(
        R"(<figure><div class="scroll">{}</div><figcaption>{}</figcaption></figure>)", bars,
        of_cloud
            ? tr("Budget: what each influence does alone, ranked: standard uncertainty, share of "
                 "the sum of squares, mean shift of the value. Blue: at the sampled points, shares "
                 "among themselves; orange: of the whole surface, share of all.")
            : tr("Budget: what each influence does alone, ranked: standard uncertainty, share of "
                 "the sum of squares, change of the value for +1 standard uncertainty."));
  }
  return html + declaration(u.declaration);
}

std::string absent_notes(const evaluation::FeatureResult& feature) {
  std::string html;
  for (const AbsentInterval& absent : absent_intervals(feature)) {
    std::string names;
    for (const std::string& id : absent.ids)
      names += (names.empty() ? "" : tr(", ")) + isolated(id);
    html += note(trf("No interval of {}: {}.", names, in_sentence(absent.why)));
  }
  return html;
}

}  // namespace

std::string rule_section(const evaluation::Evaluation& evaluation) {
  const std::string sentence =
      in_sentence(rule_sentence(evaluation),
                  evaluation.rule ? std::string_view() : evaluation.rule.error().what);
  if (!evaluation.rule || !evaluation.rule->needs_interval()) {
    return note(trf("Decision rule: {}.", sentence));
  }
  return fmt::format(R"(<div class="rule"><b>{}</b> {}<div class="note">{}</div>{}</div>)",
                     tr("Decision rule."), trf("{}.", sentence), tr(kFormulaLetters),
                     statements(*evaluation.rule));
}

std::string uncertainty_section(const evaluation::FeatureResult& feature) {
  std::string html = absent_notes(feature);
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    if (result.value && result.value->uncertainty().result())
      html += value_part(result, !record::is_analysis(feature.feature.shape));
  }
  return html;
}

}  // namespace rondure::reports
