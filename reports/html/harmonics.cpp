
#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/harmonic_mask.h"
#include "reports/escaping.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::um;

/// Table of the harmonics beyond a mask, or a note that there are none.
std::string against_limits(const evaluation::FeatureResult& feature,
                           const record::Characteristic& asked) {
  TableRows rows;
  for (const evaluation::MaskedHarmonic& masked : against_mask(feature, asked)) {
    if (!masked.exceeds()) continue;
    rows.push_back({std::to_string(masked.harmonic.number),
                    std::to_string(masked.harmonic.layer + 1), um(masked.harmonic.amplitude_mm),
                    um(masked.limit_mm), um(masked.harmonic.amplitude_mm - masked.limit_mm)});
  }
  if (rows.empty()) {
    return note(trf("No harmonic goes beyond the limits of {}.", isolated(asked.id)));
  }
  return table("short", "rrrrr",
               fmt::format("<caption>{}</caption>",
                           trf("Harmonics beyond the limits of {}", isolated(asked.id))),
               {"UPR", tr("Layer"), tr("Amplitude / µm"), tr("Limit / µm"), tr("Beyond by / µm")},
               rows);
}

}  // namespace

std::string harmonics_section(const evaluation::FeatureResult& feature) {
  std::vector<Bar> bars;
  for (const evaluation::SectionHarmonic& harmonic : worst_harmonics(feature)) {
    if (harmonic.number < 2) continue;  // eccentricity is no form
    bars.push_back({harmonic.number, harmonic.amplitude_mm / core::kMicrometre});
  }
  if (bars.empty()) return {};
  const std::vector<BarLimit> limits = limits_of(feature.feature.characteristics);
  std::string words;
  for (const record::Characteristic& asked : feature.feature.characteristics) {
    if (!asked.harmonic_limits.empty()) words += against_limits(feature, asked);
  }
  const std::string note =
      limits.empty() ? tr("Before the filter, of each undulation in the section where it is "
                          "largest. The plan gives no limits.")
                     : tr("Before the filter, of each undulation in the section where it is "
                          "largest. Lines: the limits of the mask.");
  return fmt::format(R"(<h3>{}</h3><p class="note">{}</p><div class="scroll">{}</div>{})",
                     tr("Harmonics of the sections"), note,
                     bar_chart(tr("Amplitudes of the harmonics"), tr("undulations per revolution"),
                               tr("amplitude / µm"), bars, limits),
                     words);
}

}  // namespace rondure::reports
