#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "evaluation/part/place.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/thermal.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/callouts.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;

std::string css_name(evaluation::Verdict verdict) {
  std::string name = fmt::format("is-{}", name_of(verdict));
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string unfinished_banner(const record::RunRecord& record,
                              const evaluation::Evaluation& evaluation) {
  if (record.ending == "finished") return {};
  std::string html =
      fmt::format(R"(<div class="banner alarm"><b>{}</b> )", tr("This run did not finish."));
  html += record.ending.empty() ? tr("It has no end on record.")
                                : trf("It ended: {}.", worded(core::Phrase(record.ending)));
  if (record.failure) {
    html += fmt::format(R"( {} {}{} <span class="code">{}</span>)", tr("Reason:"),
                        titled(record.failure->code), foreign(record.failure->what),
                        core::code_name(record.failure->code));
    if (!record.failure->where.empty()) html += trf(" at {}", foreign(record.failure->where));
  }
  html += "<ul>";
  for (const std::string& part : missing_parts(record, evaluation)) {
    html += fmt::format("<li>{}</li>", isolated(part));
  }
  return html + "</ul></div>";
}

/// "30 0/-0.013 E", as a drawing states a size, with the circled letters of ISO 14405-1.
std::string size_frame(const record::Feature& feature, const record::Characteristic& asked) {
  using Indication = record::Indication;
  std::string size;
  if (feature.nominal_diameter_mm > 0.0 && evaluation::unit_of(asked) == core::ValueUnit::kMm) {
    size = fmt::format("Ø{:.10g}", feature.nominal_diameter_mm);
    const auto deviation = [&](const std::optional<double>& limit_mm) {
      if (!limit_mm) return std::string("–");
      const double by_mm = core::on_grid(*limit_mm - feature.nominal_diameter_mm, 1e6);
      return (by_mm > 0.0 ? "+" : "") + core::decimal(by_mm == 0.0 ? 0.0 : by_mm);
    };
    if (asked.toleranced()) {
      size += fmt::format(R"(<span class="deviations"><span>{}</span><span>{}</span></span>)",
                          deviation(asked.tolerance_mm), deviation(asked.lower_mm));
    }
  } else {
    size = limits_in_words(asked, tr(", "));
  }
  const Indication& indication = asked.indication;
  const auto circled = [&](std::string_view letters) {
    size += fmt::format(R"(<span class="modifier">{}</span>)", letters);
  };
  if (indication.requirement == Indication::Requirement::kEnvelope) {
    circled("E");
  } else {
    circled(record::name_of(indication.size));
    if (indication.rank) circled(record::name_of(*indication.rank));
    if (indication.section != Indication::Section::kAll)
      size += fmt::format(" {}", record::name_of(indication.section));
  }
  return fmt::format(R"(<span class="frame-box size"><span>{}</span></span>)", size);
}

/// Whether the tolerance zone is a cylinder.
bool is_diametral(const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  if (asked.form == record::Form::kStraightness)
    return asked.indication.of == record::Indication::Of::kMedianLine;
  if (result.finding) return result.finding->judged.front().symbol.ends_with("\u00d8");
  return asked.form == record::Form::kCoaxiality || asked.form == record::Form::kConcentricity;
}

/// Tolerance frame: symbol, limit in mm, datums. A characteristic that ISO 1101 does not know has
/// no frame: a line with its symbol and its limits in its place.
std::string tolerance_frame(const record::Feature& feature,
                            const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  if (asked.form == record::Form::kDiameter) return size_frame(feature, asked);
  const std::string symbol = form_symbol(asked.form);
  if (symbol.empty()) {
    return fmt::format(R"(<span class="plain">{} {}</span> )",
                       escaped(tr(evaluation::symbol_of(asked))), limits_in_words(asked, tr(", ")));
  }
  std::string cells;
  if (asked.tolerance_mm) {
    cells =
        fmt::format("<span>{}{:g}</span>", is_diametral(result) ? "Ø" : "", *asked.tolerance_mm);
  }
  for (const std::string& datum : asked.indication.datum)
    cells += fmt::format("<span>{}</span>", isolated(datum));
  return fmt::format(R"(<span class="frame-box"><span>{}</span>{}</span>)", symbol, cells);
}

/// A probability estimated from trials, with a resolution no finer than one trial.
std::string percent(double share_1, double trials) {
  const double finest = std::pow(10.0, std::ceil(std::log10(100.0 / trials)));  // in percent
  if (share_1 * trials < 0.5) return trf("below {:g} %", finest);
  if ((1.0 - share_1) * trials < 0.5) return trf("above {:g} %", 100.0 - finest);
  const int decimals = std::max(0, -static_cast<int>(std::lround(std::log10(finest))));
  return fixed(100.0 * share_1, decimals) + " %";
}

/// Probability of conformance and risks; empty without an interval.
std::string risks_in_words(const evaluation::CharacteristicResult& result) {
  std::string html;
  if (!result.outcome->conformance_1) return html;
  const double trials = result.value->uncertainty().result()->trials;
  html += "<br/>" +
          trf("Probability of conformance: {}.", percent(*result.outcome->conformance_1, trials));
  if (const auto risk = result.outcome->specific_risk_1()) {
    html += result.verdict == evaluation::Verdict::kConforms
                ? trf(" Specific consumer's risk of this verdict: {}.", percent(*risk, trials))
                : trf(" Specific producer's risk of this verdict: {}.", percent(*risk, trials));
  }
  if (result.risks) {
    html += trf(
        " Over the parts of the stated prior: {} conform not and are accepted (global consumer's "
        "risk), {} conform and are rejected (global producer's risk).",
        percent(result.risks->false_acceptance_1, trials),
        percent(result.risks->false_rejection_1, trials));
  }
  return html;
}

/// Share of the limit on the one scale of the page: the tick is the limit.
std::string share_bar(const Callout& callout) {
  if (!callout.share_1) return {};
  constexpr double kWidth = 96.0;
  constexpr double kMiddle = 7.0;
  const Scale x{0.0, 1.0, 0.5, 72.0};
  Svg svg(kWidth, 14.0, "bar", trf("{} % of the limit", fixed(100.0 * *callout.share_1, 0)));
  svg.rect(0.0, kMiddle - 3.0, kWidth, 6.0, "allowed");
  const evaluation::Verdict verdict = callout.result->verdict;
  svg.rect(0.0, kMiddle - 3.0, std::min(x.at(*callout.share_1), kWidth), 6.0,
           verdict == evaluation::Verdict::kConforms         ? "good"
           : verdict == evaluation::Verdict::kDoesNotConform ? "bad"
                                                             : "neutral");
  svg.line(x.at(1.0), 1.0, x.at(1.0), 13.0, "limit");
  return svg.str();
}

/// The footnotes of the table, each once; the letter of a note.
class Footnotes {
 public:
  std::string letter(const std::string& html) {
    if (html.empty()) return {};
    const auto known = std::ranges::find(notes_, html);
    const auto index = static_cast<std::size_t>(known - notes_.begin());
    if (known == notes_.end()) notes_.push_back(html);
    return fmt::format("<sup>{}</sup>", name_of(index));
  }
  [[nodiscard]] std::string text() const {
    std::string html;
    for (std::size_t i = 0; i < notes_.size(); ++i)
      html += fmt::format(" <b>{}</b> {}.", name_of(i), notes_[i]);
    return html;
  }

 private:
  static std::string name_of(std::size_t index) {
    return index < 26 ? std::string(1, static_cast<char>('a' + index)) : std::to_string(index);
  }
  std::vector<std::string> notes_;
};

/// A part of the verification operator of a value; empty without a value.
enum class OperatorPart : std::size_t { kFilter = 1, kSampling = 2 };
std::string operator_part(const evaluation::CharacteristicResult& result, OperatorPart part) {
  if (!result.value) return {};
  const auto& arguments = result.value->value_operator().words().arguments();
  const auto* words =
      std::get_if<core::Phrase>(&arguments.at(static_cast<std::size_t>(part)).value);
  return words == nullptr ? std::string() : in_sentence(*words);
}

/// The filter of most call-outs.
std::string usual_filter(const std::vector<Callout>& callouts) {
  std::map<std::string, int> number;
  for (const Callout& one : callouts) {
    if (one.result->value) ++number[operator_part(*one.result, OperatorPart::kFilter)];
  }
  const auto most =
      std::ranges::max_element(number, {}, [](const auto& one) { return one.second; });
  return most == number.end() ? std::string() : most->first;
}

/// "U, 95 %", without the probability where it is not one for all.
std::string expanded_head(const std::vector<Callout>& callouts) {
  std::optional<double> coverage_1;
  for (const Callout& one : callouts) {
    if (one.expanded.empty()) continue;
    const double own_1 = one.result->value->uncertainty().coverage_1();
    if (coverage_1.value_or(own_1) != own_1) return "U";
    coverage_1 = own_1;
  }
  return coverage_1 ? trf("U, {:g} %", 100.0 * *coverage_1) : "U";
}

bool is_size(const Callout& callout) {
  return callout.result->characteristic.form == record::Form::kDiameter;
}

/// The mark of a call-out on the drawing: "28h6" of a size, a name of one word such as "K7". Other
/// names describe what frame and symbol say, and would make lines of a long table two.
std::string mark_on_drawing(const Callout& callout) {
  const std::string& id = callout.result->characteristic.id;
  const bool shown = is_size(callout) || id.find(' ') == std::string::npos;
  return fmt::format(" <small>{}</small>", isolated(shown ? core::printable(id) : ""));
}

std::string row(const Callout& callout, const std::string& usual, const std::string& expanded,
                Footnotes& notes) {
  const evaluation::CharacteristicResult& result = *callout.result;
  const record::Characteristic& asked = result.characteristic;
  const auto cell = [](std::string_view css_class, const std::string& name,
                       const std::string& html) {
    return fmt::format(R"(<td class="{}" data-l="{}">{}</td>)", css_class, name, html);
  };
  std::string letters;
  if (const std::string filter = operator_part(result, OperatorPart::kFilter); filter != usual)
    letters += notes.letter(filter);
  if (const std::string own = own_rule_in_words(asked); !own.empty())
    letters += notes.letter(trf("Decision rule of this line: {}", escaped(own)));
  letters += notes.letter(values_about_datum(result));
  std::string html = fmt::format(
      R"(<tr title="{}"><td>{}{}</td>)", escaped(core::printable(asked.id)),
      tolerance_frame(callout.feature->feature, result),
      asked.drawing_zone.empty() ? std::string()
                                 : fmt::format(" <small>{}</small>", isolated(asked.drawing_zone)));
  html += fmt::format("<td>{}</td><td>{} <small>{}</small>{}{}</td>",
                      isolated(callout.feature->feature.id), escaped(callout.symbol),
                      evaluation::reference_of(asked), letters, mark_on_drawing(callout));
  html += cell("n", tr("Value"),
               callout.value.empty() ? tr("none")
                                     : fmt::format(R"(<b class="value">{}</b>)", callout.value));
  html += cell("n", expanded, callout.expanded) + cell("n", tr("Limit"), callout.limit) +
          cell("n", tr("Deviation"), callout.deviation) +
          cell("", tr("Share of the limit"), share_bar(callout)) +
          cell("place", tr("Worst at"), callout.place);
  return html + fmt::format(R"(<td class="verdict-word {}">{}{}</td></tr>)",
                            css_name(result.verdict), verdict_mark(result.verdict, 14),
                            capitalised(tr(name_of(result.verdict))));
}

std::string results_table(const std::vector<Callout>& callouts) {
  if (callouts.empty()) return fmt::format("<p>{}</p>", tr("No characteristic was asked for."));
  const std::string usual = usual_filter(callouts);
  Footnotes notes;
  std::string rows;
  const std::string expanded = expanded_head(callouts);
  for (const Callout& callout : callouts) rows += row(callout, usual, expanded, notes);
  std::string html =
      fmt::format(R"(<table class="results">{}<thead><tr>)", spoken_caption(tr("Result")));
  const std::vector<std::pair<std::string, bool>> names = {{tr("Call-out"), false},
                                                           {tr("Feature"), false},
                                                           {tr("Characteristic"), false},
                                                           {tr("Value"), true},
                                                           {expanded, true},
                                                           {tr("Limit"), true},
                                                           {tr("Deviation"), true},
                                                           {tr("Share of the limit"), false},
                                                           {tr("Worst at"), false},
                                                           {tr("Verdict"), false}};
  for (const auto& [name, number] : names)
    html += fmt::format(R"(<th scope="col"{}>{}</th>)", number ? R"( class="n")" : "", name);
  html += "</tr></thead><tbody>" + rows + "</tbody></table>";
  return html +
         note(
             (usual.empty() ? std::string() : trf("Unless marked: {}.", usual)) + notes.text() +
             " " +
             tr("µm; sizes in mm, angles in µrad. Bold: the value that is compared. U: half of its "
                "interval. Deviation: of a size from nominal, else beyond the limit. Bar: the tick "
                "is the limit. Worst at: part z, angle from part x."));
}

/// "CYLt of journal B"; a size as the drawing has it: "30h6 of journal A".
std::string callout_in_html(const Callout& callout) {
  return trf(
      "{0} of {1}",
      is_size(callout) ? isolated(callout.result->characteristic.id) : escaped(callout.symbol),
      isolated(callout.feature->feature.id));
}

/// The heading of its picture: of a size too this shows form, so the words claim no more.
std::string drawing_title(const Callout& callout) {
  const std::string name = callout_in_html(callout);
  if (!callout.worst_row) return name;
  return is_size(callout) ? trf("{}: form of the section where the size is worst", name)
                          : trf("{}: where it is worst", name);
}

/// Moves the section of a row into the zone of its own circle, where its roundness is.
/// @return  The width of that zone; none where the row is in no section that has one.
std::optional<double> into_own_circle(std::optional<std::size_t> row,
                                      evaluation::FeatureResult& feature) {
  for (const evaluation::LayerResult& layer : feature.layers) {
    if (!row || std::ranges::find(layer.rows, *row) == layer.rows.end()) continue;
    if (!layer.mz || layer.points_mm.size() != layer.rows.size()) return std::nullopt;
    const double middle_mm = 0.5 * (layer.mz->inner_radius_mm + layer.mz->outer_radius_mm);
    for (std::size_t i = 0; i < layer.rows.size(); ++i) {
      evaluation::CloudPoint& point = feature.cloud[layer.rows[i]];
      point.deviation_mm = (layer.points_mm[i] - layer.mz->center_mm).norm() - middle_mm;
      const auto touches = [i](const fit::Contact& contact) { return contact.index == i; };
      point.outer_contact = std::ranges::any_of(layer.mz->outer, touches);
      point.inner_contact = std::ranges::any_of(layer.mz->inner, touches);
    }
    return layer.mz->width_mm();
  }
  return std::nullopt;
}

/// The worst call-out: the lines that its value was found on, or the section where it is worst and
/// the whole surface beside it.
std::string worst_drawing(const Callout* callout) {
  if (callout == nullptr) return {};
  const evaluation::FeatureResult& feature = *callout->feature;
  const DrawnFeature drawn = drawn_of(feature, callout->worst_row);
  const std::string title = fmt::format("<h3>{}</h3>", drawing_title(*callout));
  if (feature.mz_plane) return title + face_map(drawn.feature);
  if (const std::string lines = line_plots(*callout->result); !lines.empty())
    return fmt::format(R"({}<div class="views">{}</div>)", title, lines);
  const std::string map = deviation_map(drawn.feature, *drawn.zone, drawn.places);
  if (!zone_of(feature)) return title + map;
  evaluation::FeatureResult section = drawn.feature;
  evaluation::Zone zone = *drawn.zone;
  if (callout->result->characteristic.form == record::Form::kRoundness) {
    zone.deviation_mm = into_own_circle(drawn.places.worst, section).value_or(zone.deviation_mm);
  }
  return fmt::format(R"({}<div class="worst-one">{}<div>{}</div></div>)", title,
                     worst_section(section, zone, feature, drawn.places),
                     map.substr(map.find("<figure")));  // one heading is enough
}

bool is_of_file(const record::Feature& feature) {
  return feature.strategy == record::Strategy::kPointsFile;
}

/// "5 x 360 points, scanned (journal A, journal B); 3737 touches, 12 min".
std::string measured_in_words(const record::RunRecord& record,
                              const evaluation::Evaluation& evaluation) {
  std::vector<std::pair<std::string, std::string>> groups;  // sampling, names
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    std::string sampling;
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      if (sampling.empty()) sampling = operator_part(result, OperatorPart::kSampling);
    }
    if (sampling.empty()) continue;
    auto known = std::ranges::find(groups, sampling, &std::pair<std::string, std::string>::first);
    if (known == groups.end()) known = groups.insert(known, {sampling, {}});
    known->second += (known->second.empty() ? "" : tr(", ")) + isolated(feature.feature.id);
  }
  std::string html;
  for (const auto& [sampling, names] : groups)
    html += fmt::format("{}{} ({})", html.empty() ? "" : tr("; "), sampling, names);
  if (std::ranges::any_of(record.features, is_of_file)) html += tr("; ") + tr("points from a file");
  const auto qualifying = static_cast<std::size_t>(std::ranges::count(
      record.touches, record::Touch::Purpose::kQualification, &record::Touch::purpose));
  if (qualifying < record.touches.size() && record.touches.back().time_s > 0.0) {
    html += (html.empty() ? "" : tr("; ")) +
            trf("{} in {} min", count(record.touches.size(), "touch", "touches"),
                fixed((record.touches.back().time_s - record.touches.front().time_s) / 60.0, 0));
  }
  if (evaluation.probe) {
    html += tr("; ") + trf("qualification with {}, probing form {} µm",
                           count(qualifying, "touch", "touches"),
                           fixed(1e3 * evaluation.probe->form_mm, 2));
  }
  return html.empty() ? tr("nothing") : html;
}

/// "journal A 13.0 … 27.0 mm; journal B ...": the heights that touches reached, in part z.
std::string seen_heights(const evaluation::Evaluation& evaluation) {
  std::string html;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    const record::Shape shape = feature.feature.shape;
    if (shape != record::Shape::kCylinder && shape != record::Shape::kCone) continue;
    if (feature.cloud.empty() || is_of_file(feature.feature)) continue;
    const auto places = evaluation::places_on_part(feature);
    if (places.empty() || !places.front().z_mm) continue;
    const auto [low, high] =
        std::ranges::minmax_element(places, {}, &evaluation::PlaceOnPart::z_mm);
    html += fmt::format("{}{} {} … {} mm", html.empty() ? "" : tr(", "),
                        isolated(feature.feature.id), fixed(*low->z_mm, 1), fixed(*high->z_mm, 1));
  }
  return html;
}

std::string not_seen_in_words(const evaluation::Evaluation& evaluation) {
  const auto axes = [](const evaluation::FeatureResult& feature) {
    return feature.feature.shape == record::Shape::kRotaryAxes ||
           feature.feature.shape == record::Shape::kFiveAxis;
  };
  const auto of_axes = std::ranges::count_if(evaluation.features, axes);
  std::string html;
  if (std::ssize(evaluation.features) > of_axes) html = tr("the surface between the points");
  if (of_axes > 0) {
    html += (html.empty() ? "" : tr("; ")) + tr("the errors of the axes between the stations");
  }
  if (const std::string seen = seen_heights(evaluation); !seen.empty())
    html += tr("; ") + trf("all outside these part z: {}", seen);
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    const auto left_out =
        std::ranges::count(feature.cloud, true, &evaluation::CloudPoint::left_out);
    if (left_out > 0) {
      html += tr("; ") + trf("{} of {} points of {}, left out in windows by the plan", left_out,
                             feature.cloud.size(), isolated(feature.feature.id));
    }
    if (feature.failure) html += tr("; ") + trf("all of {}", isolated(feature.feature.id));
  }
  return html;
}

std::string foot(const record::Header& header) {
  return fmt::format(
      R"(<div class="foot"><div class="sign-box">{}</div><dl class="facts">{}</dl></div>)",
      tr("name, date, signature"),
      entry(tr("Run"), isolated(header.run_id)) +
          entry(tr("Plan SHA-256"), fmt::format(R"(<span class="mono">{}</span>)",
                                                escaped(header.plan_sha256.substr(0, 16)))) +
          entry(tr("Key"), "", "fill") +
          entry(tr("To check"),
                R"(<span class="mono">rondure verify RUN_DIR --key PUBLIC.pem</span>)"));
}

}  // namespace

std::string entry(std::string_view name, std::string_view html, std::string_view css_class) {
  if (css_class.empty()) return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, html);
  return fmt::format(R"(<div class="{}"><dt>{}</dt><dd>{}</dd></div>)", css_class, name, html);
}

namespace {

/// An entry of the head; without a text a line to fill in.
std::string field(const std::string& name, const std::string& html) {
  return entry(name, html, html.empty() ? "fill" : "");
}

/// "20.1 … 20.4 °C", and whether it is what the sensor or what the plan says.
std::string temperature_in_words(const record::RunRecord& record,
                                 const evaluation::Evaluation& evaluation) {
  std::optional<evaluation::Temperatures> all;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    if (!feature.temperatures) continue;
    if (!all) all = feature.temperatures;
    all->least_degC = std::min(all->least_degC, feature.temperatures->least_degC);
    all->greatest_degC = std::max(all->greatest_degC, feature.temperatures->greatest_degC);
    all->declared |= feature.temperatures->declared;
  }
  if (!all) return {};
  const std::string low = fixed(all->least_degC, 1);
  const std::string high = fixed(all->greatest_degC, 1);
  const std::string said = (low == high ? low : fmt::format("{} … {}", low, high)) + " °C";
  if (all->declared) return said + ", " + tr("declared, not measured");
  const auto assumed_degC = evaluation::assumed_degC(record);
  if (!assumed_degC || fixed(*assumed_degC, 1) == said.substr(0, said.find(' '))) return said;
  return trf("{} measured; {:g} °C of the plan not used", said, *assumed_degC);
}

std::string probe_in_words(const record::RunRecord& record,
                           const evaluation::Evaluation& evaluation) {
  if (evaluation.probe) {
    return trf("tip {:g} mm, form {} µm", 2.0 * record.artefact.nominal_tip_radius_mm,
               fixed(1e3 * evaluation.probe->form_mm, 2));
  }
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    if (!feature.tip_radius_mm) continue;
    return *feature.tip_radius_mm == 0.0 ? tr("points of the surface")
                                         : trf("tip {:g} mm", 2.0 * *feature.tip_radius_mm);
  }
  return {};
}

}  // namespace

namespace {

/// Logo and name of the laboratory, and below them where it is; without one a line to fill in.
std::string laboratory_in_words(const record::HeadSettings& people) {
  if (!people.laboratory) return R"(<span class="fill lab"></span>)";
  std::string html = R"(<div class="lab">)";
  // A journal is a file that anybody can write: only a picture goes into the page.
  const std::string logo = people.logo.value_or("");
  if (logo.starts_with("data:image/png;base64,") || logo.starts_with("data:image/jpeg;base64,")) {
    html += fmt::format(R"(<img src="{}" alt=""/>)", escaped(logo));
  }
  html += fmt::format("<b>{}</b>", isolated(*people.laboratory));
  for (const auto* const part : {&people.address, &people.country, &people.contact}) {
    if (*part) html += "<br/>" + isolated(**part);
  }
  return html + "</div>";
}

}  // namespace

std::string head_section(const record::RunRecord& record, const std::string& kind,
                         const evaluation::Evaluation* evaluation) {
  const record::Header& header = record.header;
  const record::HeadSettings people = people_of(record);
  const auto text = [](const std::string& of) { return of.empty() ? of : isolated(of); };
  const auto both = [&](const std::string& one, const std::string& other) {
    return text(one) + (one.empty() || other.empty() ? "" : " ") + text(other);
  };
  std::string started = header.started_utc;  // "2026-11-21T02:33:02Z"
  if (started.size() == 20 && started[10] == 'T')
    started = started.replace(10, 1, " ").substr(0, 16) + " UTC";
  std::string html = fmt::format(
      R"(<header><div class="brand">{}<span class="kind">{}</span><h1>{}{}</h1></div>)"
      R"(<div class="ident"><dl>{}</dl><dl>{}</dl>)",
      laboratory_in_words(people), capitalised(kind), isolated(header.part_id),
      header.serial.empty() ? "" : " / " + isolated(header.serial),
      field(tr("Part"), both(header.part_id, header.part_name)) +
          field(tr("Serial"), text(header.serial)) + field(tr("Drawing"), text(header.drawing)),
      field(tr("Plan"), both(header.plan_name, header.plan_revision)) +
          field(tr("Order"), text(people.order.value_or(""))) +
          field(tr("Customer"), text(people.customer.value_or(""))));
  const bool calibrated = evaluation != nullptr && evaluation->fixture;
  const bool of_files = std::ranges::all_of(record.features, is_of_file);
  html += fmt::format(
      R"(<dl>{}</dl><dl>{}</dl></div>)",
      field(tr("Machine"), header.machine.empty() ? "" : worded(core::Phrase(header.machine))) +
          field(tr("Probe"), evaluation != nullptr ? probe_in_words(record, *evaluation) : "") +
          field(tr("Calibration"),
                calibrated ? trf("{}, valid until {}", isolated(evaluation->fixture->id),
                                 escaped(evaluation->fixture->expires_utc.substr(0, 10)))
                           : ""),
      field(tr("Operator"), text(header.operator_name)) +
          field(of_files ? tr("Evaluated") : tr("Time"), text(started)) +
          field(tr("Temperature"),
                evaluation != nullptr ? temperature_in_words(record, *evaluation) : ""));
  return html + "</header>";
}

const Callout* drawn_callout(const std::vector<Callout>& callouts) {
  const auto found = std::ranges::find_if(callouts, [](const Callout& callout) {
    return callout.feature->mz_plane || zone_to_draw(*callout.feature);
  });
  return found == callouts.end() ? nullptr : &*found;
}

namespace {

/// Why the first call-out has no verdict; empty where it has one.
std::string why_undecided(const std::vector<Callout>& callouts) {
  if (callouts.empty()) return {};
  const evaluation::CharacteristicResult& first = *callouts.front().result;
  const bool open = first.verdict == evaluation::Verdict::kVoid ||
                    first.verdict == evaluation::Verdict::kUndecided;
  return open ? "<br/>" + opening_sentence(first.reason) : std::string();
}

}  // namespace

std::string verdict_section(const record::RunRecord& record,
                            const evaluation::Evaluation& evaluation,
                            const std::vector<Callout>& callouts) {
  const evaluation::Verdict verdict = evaluation.verdict;
  std::string html = "<section>" + unfinished_banner(record, evaluation);
  html += fmt::format(
      R"(<div class="verdict">{}<div><div class="word {}" role="heading" aria-level="2">{}</div><div class="why">{}</div>)"
      "</div></div>",
      verdict_mark(verdict, 48), css_name(verdict),
      incomplete_headline(record, evaluation).value_or(capitalised(tr(name_of(verdict)))),
      answer_in_words(callouts, callout_in_html) + why_undecided(callouts));
  for (const auto& [word, text] : remarks_on(record, callouts))
    html += fmt::format(R"(<div class="banner"><b>{}</b> {}</div>)", word, text);
  html += results_table(callouts) + worst_drawing(drawn_callout(callouts));
  const std::string rule =
      in_sentence(rule_sentence(evaluation),
                  evaluation.rule ? std::string_view() : evaluation.rule.error().what);
  return html + R"(<dl class="lines">)" +
         entry(tr("Measured"), measured_in_words(record, evaluation)) + entry(tr("Rule"), rule) +
         entry(tr("Uncertainty"), uncertainty_in_words(callouts, in_sentence)) +
         entry(tr("Not seen"), not_seen_in_words(evaluation)) + "</dl>" + foot(record.header) +
         "</section>";
}

std::string verdict_in_words(const evaluation::CharacteristicResult& result) {
  std::string html = opening_sentence(result.reason);
  if (result.outcome) html += risks_in_words(result);
  if (const std::string own = own_rule_in_words(result.characteristic); !own.empty())
    html += "<br/>" + trf("Decision rule of this line: {}", escaped(own));
  if (result.value)
    html += "<br/>" + trf("Verification operator: {}", in_sentence(result.value->operator_text()));
  return fmt::format(R"(<p><b class="{}">{}</b> {}</p>)", css_name(result.verdict),
                     capitalised(tr(name_of(result.verdict))), html);
}

}  // namespace rondure::reports
