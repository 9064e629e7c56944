#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/five_axis/result.h"
#include "reports/escaping.h"
#include "reports/html/internal/axis_parts.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::kMicrometre;
using core::um;
using evaluation::FiveAxisResult;

/// Found, truth of a simulation, and their difference over u.
/// @param exact  What a simulation gives without errors of measurement; null: no simulation.
std::string location_table(const FiveAxisResult& facts, const FiveAxisResult* exact) {
  const auto truths =
      exact == nullptr ? std::vector<evaluation::HeadLocation>() : locations_of(*exact);
  TableRows rows;
  for (const evaluation::HeadLocation& one : locations_of(facts)) {
    const bool angle = record::is_angle(one.error);
    const double found = one.value_mm / kMicrometre;
    const double u = one.u_mm / kMicrometre;
    std::vector<std::string> cells = {std::string(record::name_of(one.error)),
                                      angle ? "µrad" : "µm", fixed(found, angle ? 1 : 2),
                                      fixed(u, angle ? 1 : 2)};
    const auto truth = std::ranges::find(truths, one.error, &evaluation::HeadLocation::error);
    if (truth == truths.end()) {
      cells.insert(cells.end(), 3, "–");
    } else {
      const double off = found - truth->value_mm / kMicrometre;
      cells.push_back(fixed(found - off, angle ? 1 : 2));
      cells.push_back(fixed(off, angle ? 1 : 2));
      cells.push_back(u > 0.0 ? fixed(off / u, 1) : "–");
    }
    rows.push_back(cells);
  }
  return scrolling(table("", "llrrrrr", spoken_caption(tr("Location of the axes")),
                         {tr("Error"), tr("unit"), tr("found"), "u", tr("truth"), tr("difference"),
                          tr("difference over u")},
                         rows));
}

std::string key_numbers(const FiveAxisResult& facts) {
  std::string html = R"(<dl class="keys">)";
  html += entry(tr("Left at combined poses"),
                with_note(trf("{} µm rms", um(facts.left().rms_mm)),
                          trf("{} µm at most; {} µm rms expected", um(facts.left().max_mm),
                              um(facts.gain ? facts.gain->forecast_mm : facts.study.expected_mm))),
                "lead");
  if (const auto& gain = facts.gain) {
    html += entry(tr("Without the table"),
                  with_note(trf("{} µm rms", um(gain->before.rms_mm)),
                            trf("of feature {}: {} times what is left", isolated(gain->with),
                                fixed(gain->before.rms_mm / facts.left().rms_mm, 1))));
  } else {
    html += entry(tr("Before compensation"),
                  with_note(trf("{} µm rms", um(facts.study.before.rms_mm)),
                            trf("{} µm at most", um(facts.study.before.max_mm))));
  }
  html += entry(tr("Readings"),
                with_note(trf("{} of {} set-ups", facts.readings, facts.task.balls.size()),
                          trf("u of a coordinate {} µm", um(facts.noise_mm))));
  html += entry(tr("Condition of the balls"),
                with_note(fixed(facts.condition, 2), tr("1 is best, above 10 is poor")));
  html += entry(tr("Step at C = A = 0"), with_note(um(facts.study.reference_step_mm) + " µm",
                                                   tr("largest, of a coordinate")));
  return html + "</dl>";
}

}  // namespace

std::string analysis_part(const FiveAxisResult& facts, const record::RunRecord& record, int feature,
                          const FiveAxisResult* exact) {
  std::string html = (facts.gain ? std::string() : residual_chart(facts.combined)) +
                     as_read_note() + key_numbers(facts) + words_of_rotary();
  html += fmt::format("<h3>{}</h3>{}", tr("Location of the axes"), location_table(facts, exact));
  html += note(
      tr("ISO 230-7, from the fit over the stations, relative to the tool data of the first ball "
         "and to the slides as they move. Truth: the same fit of the readings without noise. "
         "Compensation uses the whole errors."));
  html +=
      fmt::format("<h3>{}</h3>{}", tr("Combined poses"), combined_table(facts.combined, "C", "A"));
  for (const evaluation::AxisFacts& axis : axes_of(facts)) {
    html += fmt::format("<h3>{}</h3>", *axis.key == 'c' ? tr("Axis C (on the slides, about z)")
                                                        : tr("Axis A (on C, about x)"));
    html += axis_charts(axis, record.truth_series_of(feature, axis.key));
  }
  return html + note(tr("Errors relative to C = A = 0, at the pivot. A dashed line, where there is "
                        "one, is the hidden truth of the simulation: evaluation never reads it."));
}

}  // namespace rondure::reports
