#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "reports/escaping.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;

/// Meaning of the letters in the formula of the rule.
constexpr const char* kFormulaLetters = translatable(
    "T: the tolerance; y: the value corrected for noise (and, of the whole surface, for sparse "
    "sampling); [lo, hi]: its coverage interval; U: half its width.");

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
  return table("", "lll", spoken_caption(tr("Influence")),
               {tr("Influence"), tr("In the interval"), tr("As declared")}, rows);
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

std::string uncertainties_section(const evaluation::Evaluation& evaluation,
                                  const std::vector<Callout>& callouts) {
  constexpr std::size_t kMostInfluences = 3;
  TableRows rows;
  std::vector<evaluation::InfluenceStatement> influences;
  std::vector<std::string> notes;
  int trials = 0;
  const auto say = [&](const std::string& html) {
    if (std::ranges::find(notes, html) == notes.end()) notes.push_back(html);
  };
  for (const Callout& callout : callouts) {
    const auto& value = callout.result->value;
    if (!value || value->statement() == nullptr) continue;
    const evaluation::UncertaintyResult& u = *value->uncertainty().result();
    const evaluation::UncertaintyStatement& s = *value->statement();
    trials = std::max(trials, u.trials);
    std::string largest;
    std::size_t named = 0;
    for (const evaluation::BudgetLine& line : u.budget) {
      // Its share is of another sum.
      if (line.measurand != evaluation::Measurand::kSampledPoints || named == kMostInfluences)
        continue;
      largest += fmt::format("{}{} {} %", named++ == 0 ? "" : tr(", "),
                             worded(core::Phrase(line.name)), fixed(100.0 * line.share_1, 0));
    }
    const bool at_least = value->bound() == evaluation::StatedValue::Bound::kLower;
    const std::string low = value->in_digits(s.low_mm);
    const std::string high = value->in_digits(s.high_mm);
    rows.push_back({trf("{} of {}", escaped(callout.symbol), isolated(callout.feature->feature.id)),
                    value->in_digits(u.uncorrected_mm),
                    at_least ? "≥ " + low
                    : s.at_most
                        ? "≤ " + high
                        : fmt::format("{} [{}, {}]", value->in_digits(s.estimate_mm), low, high),
                    callout.expanded, std::string(core::sign_of(callout.unit)), largest});
    for (const core::Phrase& said : u.notes) say(opening_sentence(said));
    if (s.measurand == evaluation::Measurand::kWholeSurface)
      say(trf("Form spectrum of the whole surface: {}", in_sentence(u.spectrum_source)));
    for (const evaluation::InfluenceStatement& one : u.declaration) {
      const bool known = std::ranges::any_of(influences, [&](const auto& other) {
        return other.name == one.name && other.covered == one.covered && other.text == one.text;
      });
      if (!known) influences.push_back(one);
    }
  }
  std::string html;
  if (!rows.empty()) {
    html = note(trf("Monte Carlo of {} trials (JCGM 101). Corrected: free of noise and influences.",
                    trials)) +
           scrolling(table("", "lrrrll", spoken_caption(tr("Uncertainty")),
                           {tr("Call-out"), tr("As read"), tr("Corrected [interval]"), "U",
                            tr("Unit"), tr("Largest influences")},
                           rows)) +
           scrolling(declaration(influences));
  }
  for (const std::string& said : notes) html += note(said);
  for (const evaluation::FeatureResult& feature : evaluation.features)
    html += absent_notes(feature);
  if (evaluation.rule && evaluation.rule->needs_interval()) {
    html +=
        fmt::format(R"(<div class="rule"><b>{}</b> {}<div class="note">{}</div>{}</div>)",
                    tr("Decision rule."), trf("{}.", in_sentence(rule_sentence(evaluation), "")),
                    tr(kFormulaLetters), statements(*evaluation.rule));
  }
  if (html.empty()) return html;
  return fmt::format("<section><h2>{}</h2>{}</section>", tr("Uncertainty"), html);
}

}  // namespace rondure::reports
