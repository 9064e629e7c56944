#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::um;
using evaluation::Finding;
using evaluation::LocalValue;

/// Words for a number of a finding, with the unit of one that is no length of the value.
struct NumberWords {
  std::string_view name;
  const char* words;
  std::string_view unit = {};
  int decimals = 0;
};

/// Name and value of a number that explains a value. A name that is not in the table is a symbol
/// ("SX"), or that of an angle or a length in its own unit.
std::string number_entry(const evaluation::NamedNumber& number,
                         const evaluation::StatedValue& value) {
  static constexpr auto kWords = std::to_array<NumberWords>(
      {{"pairs", translatable("Opposite pairs")},
       {"lost pairs", translatable("Lost pairs: an opposite point is missing")},
       {"diameter change over length", translatable("Change of the mean diameter over the length")},
       {"cone_angle_deg", translatable("Cone angle"), "°", 5},
       {"datum_length_mm", translatable("Length of the datum"), " mm", 3},
       {"datum_distance_mm", translatable("Distance from the middle of the datum"), " mm", 3},
       {"datum_play", translatable("Play of the datum")}});
  const auto known = std::ranges::find(kWords, number.name, &NumberWords::name);
  const std::string name = known != kWords.end() ? tr(known->words) : escaped(number.name);
  if (number.length) {
    // A deviation is in um also where the value is a size.
    const bool size = value.unit() == core::ValueUnit::kMm && number.name != "SR" &&
                      number.name != "SQ" && known == kWords.end();
    return entry(name, size ? value.in_digits(number.value) + " mm" : um(number.value) + " µm");
  }
  if (known == kWords.end()) return entry(name, fmt::format("{:.6g}", number.value));
  return entry(name, fixed(number.value, known->decimals) + std::string(known->unit));
}

/// "layer 3 at 12.000 mm", "generatrix at 90.0°", "circle of radius 20.000 mm".
std::string place_words(const LocalValue& local) {
  switch (local.place) {
    case LocalValue::Place::kLayer:
      return trf("layer {} at {} mm", local.layer + 1, fixed(local.position, 3));
    case LocalValue::Place::kAngle:
      return trf("generatrix at {}°", core::deg(local.position, 1));
    case LocalValue::Place::kRadius:
      return trf("circle of radius {} mm", fixed(local.position, 3));
  }
  return {};
}

/// All local values, the worst marked: in columns side by side where there are many, folded where
/// there are very many.
std::string local_table(const evaluation::CharacteristicResult& result) {
  constexpr std::size_t kOneTable = 12;
  constexpr std::size_t kColumns = 3;
  constexpr std::size_t kMostOpen = 90;
  const Finding& finding = *result.finding;
  const std::size_t number = finding.local.size();
  if (number == 0) return {};
  const bool ranges = std::ranges::any_of(
      finding.local, [](const LocalValue& local) { return local.least_mm.has_value(); });
  const std::string unit = fmt::format(" / {}", core::sign_of(result.value->unit()));
  std::vector<std::string> names = {tr("Place")};
  if (ranges) names.push_back(tr("Least") + unit);
  names.push_back((ranges ? tr("Greatest") : tr("Value")) + unit);
  const auto cells = [&](std::size_t i) {
    const LocalValue& local = finding.local[i];
    std::vector<std::string> row = {place_words(local)};
    if (local.none) {
      row.push_back(in_sentence(local.none->said()));
      return row;
    }
    if (ranges) row.push_back(local.least_mm ? result.value->in_digits(*local.least_mm) : "");
    row.push_back(result.value->in_digits(local.value_mm));
    if (i == finding.worst && number > 1) {
      for (std::string& cell : row) cell = "<b>" + cell + "</b>";
      row.front() += " ◆ " + tr("worst");
    }
    return row;
  };
  const std::size_t columns = number > kOneTable && !ranges ? kColumns : 1;
  const std::size_t rows_each = (number + columns - 1) / columns;
  std::string html;
  for (std::size_t from = 0; from < number; from += rows_each) {
    TableRows rows;
    for (std::size_t i = from; i < std::min(from + rows_each, number); ++i)
      rows.push_back(cells(i));
    html += table(number > kOneTable ? "" : "short", ranges ? "lrr" : "lr",
                  spoken_caption(tr("Local values")), names, rows);
  }
  if (columns > 1) html = R"(<div class="side-by-side">)" + html + "</div>";
  if (number <= kMostOpen) return html;
  return fmt::format("<details><summary>{}</summary>{}</details>", trf("{} local values", number),
                     html);
}

/// The datums and, where one rocks, the values about its one-sided and about its equalised axis.
std::string datum_table(const evaluation::CharacteristicResult& result,
                        const record::RunRecord& record) {
  const Finding& finding = *result.finding;
  if (finding.datums.empty()) return {};
  TableRows rows;
  for (const evaluation::DatumResult& datum : finding.datums) {
    std::string features;
    for (const std::size_t index : datum.features) {
      if (index < record.features.size())
        features += (features.empty() ? "" : ", ") + isolated(record.features[index].id);
    }
    rows.push_back({isolated(datum.name), datum.plane ? tr("plane") : tr("axis"),
                    worded(core::Phrase(std::string(record::name_of(datum.association)))), features,
                    datum.plane ? "–" : fixed(datum.length_mm, 3),
                    datum.plane ? "–" : um(datum.play_mm)});
  }
  std::string html = scrolling(table("short", "llllrr", spoken_caption(tr("Datums")),
                                     {tr("Datum"), tr("Kind"), tr("Association"), tr("Features"),
                                      tr("Length / mm"), tr("Play / µm")},
                                     rows));
  const std::string values = values_about_datum(result);
  return values.empty() ? html : html + note(values + ".");
}

/// Rows that take no part, counted by window, with their numbers to unfold.
std::string left_out_part(const Finding& finding) {
  if (finding.left_out.empty()) return {};
  std::map<std::string, std::vector<std::size_t>> windows;
  for (const evaluation::LeftOut& row : finding.left_out) windows[row.window].push_back(row.row);
  std::string html;
  for (const auto& [name, rows] : windows) {
    std::string numbers;
    for (const std::size_t row : rows)
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", row + 1);
    html += fmt::format(
        R"(<details><summary>{}</summary><p class="note">{}</p></details>)",
        name.empty() ? trf("{} points left out by the outlier rule", rows.size())
                     : trf("{} points left out in the window {}", rows.size(), isolated(name)),
        numbers);
  }
  return html;
}

std::string finding_warnings(const Finding& finding) {
  if (finding.warnings.empty() && !finding.no_verdict) return {};
  std::string html = R"(<ul class="warnings">)";
  if (finding.no_verdict) {
    html +=
        fmt::format("<li><b>{}</b> {}</li>", tr("No verdict:"), in_sentence(*finding.no_verdict));
  }
  for (const core::Error& warning : finding.warnings) {
    html += fmt::format(R"(<li><b>{}</b> {}{} <span class="code">{}</span></li>)", tr("Warning:"),
                        titled(warning.code), in_sentence(warning.said()),
                        core::code_name(warning.code));
  }
  return html + "</ul>";
}

std::string judged_entries(const evaluation::CharacteristicResult& result) {
  const std::string unit(core::sign_of(result.value->unit()));
  std::string html;
  for (const evaluation::JudgedValue& value : result.finding->judged) {
    const auto limit = [&](const std::optional<double>& limit_mm) {
      return result.value->unit() == core::ValueUnit::kMm
                 ? core::decimal(core::on_grid(*limit_mm, 1e6))
                 : um(*limit_mm);
    };
    std::string limits;
    if (value.limits.lower_mm) limits = trf("at least {} {}", limit(value.limits.lower_mm), unit);
    if (value.limits.upper_mm) {
      limits += (limits.empty() ? "" : tr(", ")) +
                trf("at most {} {}", limit(value.limits.upper_mm), unit);
    }
    html += entry(escaped(tr(value.symbol)),
                  with_note(result.value->in_digits(value.value_mm) + " " + unit, limits));
  }
  return html;
}

bool fails(const evaluation::CharacteristicResult& result) {
  return result.verdict != evaluation::Verdict::kConforms &&
         result.verdict != evaluation::Verdict::kNotToleranced;
}

std::string callout_part(const evaluation::CharacteristicResult& result,
                         const record::RunRecord& record, double nominal_mm) {
  std::string html =
      fmt::format("<h3>{}</h3>", trf("{}: {}", isolated(result.characteristic.id),
                                     tr(evaluation::symbol_of(result.characteristic)))) +
      verdict_in_words(result);
  if (!result.finding) return html;
  const Finding& finding = *result.finding;
  html += note(trf("{}; {}.", in_sentence(finding.reference), in_sentence(finding.filter)));
  html += finding_warnings(finding);
  if (!result.value) return html + left_out_part(finding);
  html += R"(<dl class="keys">)" + judged_entries(result);
  for (const evaluation::NamedNumber& number : finding.numbers) {
    // The table of the datums states these for each of them.
    if (number.name == "datum_length_mm" || number.name == "datum_play") continue;
    html += number_entry(number, *result.value);
  }
  html += "</dl>" + datum_table(result, record) + finding_plots(result, nominal_mm);
  return html + local_table(result) + left_out_part(finding);
}

}  // namespace

std::string values_about_datum(const evaluation::CharacteristicResult& result) {
  if (!result.finding || !result.value) return {};
  const Finding& finding = *result.finding;
  constexpr double kPlay_mm = core::kMicrometre;  // less is that of every real surface
  if (std::ranges::none_of(finding.datums,
                           [](const auto& datum) { return datum.play_mm > kPlay_mm; })) {
    return {};
  }
  std::string html;
  for (std::size_t i = 0; i < std::min(finding.about_equalised_mm.size(), finding.judged.size());
       ++i) {
    const std::string unit(core::sign_of(result.value->unit()));
    html += (html.empty() ? "" : "; ") +
            trf("{}: {} about the one-sided datum, {} about the equalised one",
                escaped(tr(finding.judged[i].symbol)),
                result.value->in_digits(finding.judged[i].value_mm) + " " + unit,
                result.value->in_digits(finding.about_equalised_mm[i]) + " " + unit);
  }
  return html;
}

bool has_findings(const evaluation::Evaluation& evaluation) {
  return std::ranges::any_of(evaluation.features, [](const evaluation::FeatureResult& feature) {
    return feature.mz_plane || feature.mz_cone || feature.mz_sphere ||
           std::ranges::any_of(feature.characteristics,
                               [](const auto& r) { return r.finding != nullptr; });
  });
}

std::string callouts_section(const evaluation::FeatureResult& feature,
                             const record::RunRecord& record, bool failing) {
  std::string html;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    if (fails(result) != failing) continue;
    html += fmt::format(R"(<div class="callout">{}</div>)",
                        callout_part(result, record, feature.feature.nominal_diameter_mm));
  }
  return html;
}

}  // namespace rondure::reports
