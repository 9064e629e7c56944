#include <fmt/format.h>

#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/messages.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using evaluation::Gate;

/// Marks differ in shape and colour, and words stand beside them: print in grey loses nothing.
std::string mark_of(Gate::Outcome outcome) {
  constexpr int kSize_px = 16;
  switch (outcome) {
    case Gate::Outcome::kPassed:
      return verdict_mark(evaluation::Verdict::kConforms, kSize_px);
    case Gate::Outcome::kWarns:
    case Gate::Outcome::kBounds:
      return verdict_mark(evaluation::Verdict::kUndecided, kSize_px);
    case Gate::Outcome::kVoids:
      break;
  }
  return verdict_mark(evaluation::Verdict::kVoid, kSize_px);
}

std::string number_cell(const std::optional<double>& number, const std::string& unit) {
  return escaped(number_of(number, unit == "um"     ? "µm"
                                   : unit == "urad" ? "µrad"
                                   : unit == "deg"  ? "°"
                                   : unit == "degC" ? "°C"
                                                    : unit));
}

}  // namespace

std::string gates_section(const evaluation::FeatureResult& feature) {
  if (feature.gates.empty()) return {};
  TableRows rows;
  for (const Gate& gate : feature.gates) {
    const bool passed = gate.outcome == Gate::Outcome::kPassed;
    std::string outcome =
        mark_of(gate.outcome) + " " +
        (passed ? tr("passed") : fmt::format("<b>{}</b>", effect_of(gate.outcome)));
    rows.push_back({with_note(opening_sentence(gate.condition),
                              fmt::format(R"(<span class="code">{}</span>)", escaped(gate.code))),
                    number_cell(gate.found, gate.unit), number_cell(gate.limit, gate.unit),
                    with_note(outcome, gate.reason.empty() ? "" : in_sentence(gate.reason))});
  }
  const std::string title = tr("Conditions of the values");
  return fmt::format("<h3>{}</h3>", title) +
         note(tr("Checked before any value was judged. A condition that is not passed makes values "
                 "void, turns them into bounds, or stands beside them as a warning.")) +
         scrolling(table("gates", "lrrl", spoken_caption(title),
                         {tr("Condition"), tr("Found"), capitalised(tr("limit")), tr("Outcome")},
                         rows));
}

}  // namespace rondure::reports
