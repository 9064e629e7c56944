#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/gates.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::um;

std::string css_name(evaluation::Verdict verdict) {
  std::string name = fmt::format("is-{}", name_of(verdict));
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

/// Whether the limits are not the one upper limit of a deviation.
bool has_sides(const record::Characteristic& asked) {
  return asked.lower_mm || evaluation::unit_of(asked) == core::ValueUnit::kMm;
}

/// A limit, which is the sum of a nominal size and a deviation.
std::string limit_text(core::ValueUnit unit, double limit_mm) {
  constexpr double kSteps = 1e6;  // of a nanometre
  return fmt::format(
      "{} {}",
      unit == core::ValueUnit::kMm ? core::decimal(core::on_grid(limit_mm, kSteps)) : um(limit_mm),
      core::sign_of(unit));
}

/// "&le; 30 mm, &ge; 29.987 mm".
std::string limits_of(const record::Characteristic& asked, std::string_view between) {
  const core::ValueUnit unit = evaluation::unit_of(asked);
  std::string html;
  if (asked.tolerance_mm) html += "≤ " + limit_text(unit, *asked.tolerance_mm);
  if (asked.tolerance_mm && asked.lower_mm) html += between;
  if (asked.lower_mm) html += "≥ " + limit_text(unit, *asked.lower_mm);
  return html;
}

/// Reason for the verdict in one line.
std::string sentence(const evaluation::Evaluation& evaluation) {
  std::size_t toleranced = 0;
  std::size_t conforming = 0;
  const evaluation::CharacteristicResult* only = nullptr;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      if (!result.characteristic.toleranced()) continue;
      ++toleranced;
      only = &result;
      if (result.verdict == evaluation::Verdict::kConforms) ++conforming;
    }
  }
  if (toleranced == 0) return tr("No characteristic has a tolerance.");
  if (toleranced > 1) {
    return conforming == 1
               ? trf("{} of {} toleranced characteristics conforms.", conforming, toleranced)
               : trf("{} of {} toleranced characteristics conform.", conforming, toleranced);
  }
  if (has_sides(only->characteristic)) {
    if (!only->value)
      return trf("There is no value to hold against {}.",
                 limits_of(only->characteristic, tr(", ")));
    return trf("{} {}, limits {}.", tr(evaluation::symbol_of(only->characteristic)),
               in_sentence(only->value->value_text()), limits_of(only->characteristic, tr(", ")));
  }
  const std::string limit =
      limit_text(evaluation::unit_of(only->characteristic), *only->characteristic.tolerance_mm);
  if (!only->value) return trf("There is no value to hold against {}.", limit);
  return trf("{} {}, limit {}.", tr(evaluation::symbol_of(only->characteristic)),
             in_sentence(only->value->value_text()), limit);
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
    size = limits_of(asked, tr(", "));
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
                       escaped(tr(evaluation::symbol_of(asked))), limits_of(asked, tr(", ")));
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

/// The judged values; of a value without a finding, itself with the limits of its characteristic.
std::vector<evaluation::JudgedValue> judged_values(const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  std::vector<evaluation::JudgedValue> judged;
  if (result.finding) judged = result.finding->judged;
  if (judged.empty()) judged = {{"", 0.0, {asked.lower_mm, asked.tolerance_mm}}};
  if (judged.size() == 1) judged.front().value_mm = result.value->quoted_mm();
  return judged;
}

std::string bar_cell(const evaluation::CharacteristicResult& result) {
  const auto& limit = result.characteristic.tolerance_mm;
  if (!result.value || !result.characteristic.toleranced()) return "<td></td>";
  // A signed value below zero does not fit on a bar that begins there.
  if (has_sides(result.characteristic) || result.value->quoted_mm() < 0.0)
    return fmt::format("<td>{}</td>", limits_bar(result, judged_values(result)));
  if (!(*limit > 0.0)) return "<td></td>";
  return fmt::format(
      R"(<td>{}<div class="note">{}</div></td>)", tolerance_bar(result, *limit),
      trf("{} % of the limit", fixed(100.0 * result.value->quoted_mm() / *limit, 0)));
}

/// The deciding value, the one bold number; the interval and the other values as notes.
std::string value_cell(const evaluation::StatedValue& value) {
  std::string html =
      fmt::format(R"(<span class="value">{}{}</span> {})", bound_sign(value, "≤ ", "≥ "),
                  value.in_digits(value.quoted_mm()), core::sign_of(value.unit()));
  const auto add_note = [&](const std::string& text) {
    html += fmt::format(R"(<div class="note">{}</div>)", text);
  };
  const evaluation::UncertaintyStatement* known = value.statement();
  const std::string interval = known == nullptr
                                   ? std::string()
                                   : fmt::format("[{}, {}]", value.in_digits(known->low_mm),
                                                 value.in_digits(known->high_mm));
  if (is_bound(value)) {
    add_note(std::string(bound_sign(value, tr("upper bound only"), tr("lower bound only"))));
  } else if (value.quoted_as_read() && known != nullptr) {
    add_note(known->at_most
                 ? trf("as read; corrected ≤ {}", value.in_digits(known->high_mm))
                 : trf("as read; corrected {} {}", value.in_digits(known->estimate_mm), interval));
  } else if (known != nullptr) {
    add_note(interval);
  }
  if (known != nullptr && !value.quoted_as_read())
    add_note(trf("as read {}", value.in_digits(value.value_mm())));
  return html;
}

/// Several judged values, each with its symbol; the stated one with its interval.
std::string values_cell(const evaluation::CharacteristicResult& result) {
  const evaluation::StatedValue& stated = *result.value;
  if (!result.finding || result.finding->judged.size() < 2) return value_cell(stated);
  std::string html;
  for (const evaluation::JudgedValue& value : result.finding->judged) {
    html +=
        value.value_mm == stated.value_mm()
            ? value_cell(stated)
            : fmt::format("{} {}", stated.in_digits(value.value_mm), core::sign_of(stated.unit()));
    html += fmt::format(R"(<div class="note">{}</div>)", escaped(tr(value.symbol)));
  }
  return html;
}

std::string limits_cell(const record::Characteristic& asked) {
  if (!asked.toleranced()) return tr("none");
  return has_sides(asked) ? limits_of(asked, "<br/>")
                          : limit_text(evaluation::unit_of(asked), *asked.tolerance_mm);
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

std::string row(const evaluation::FeatureResult& feature,
                const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  std::string html =
      fmt::format(R"(<tr><td>{}<span class="id">{}</span><div class="note">{}</div></td>)",
                  tolerance_frame(feature.feature, result), isolated(asked.id),
                  trf("{} {} · feature {}", tr(evaluation::symbol_of(asked)),
                      evaluation::reference_of(asked), isolated(feature.feature.id)));
  html += fmt::format(R"(<td class="n" data-l="{}">{}</td>)", tr("Value"),
                      result.value ? values_cell(result) : tr("none"));
  html += fmt::format(R"(<td class="n" data-l="{}">{}</td>)", tr("Limit"), limits_cell(asked));
  html += bar_cell(result);
  html += fmt::format(R"(<td class="verdict-word {}">{}{}</td>)", css_name(result.verdict),
                      verdict_mark(result.verdict, 20), capitalised(tr(name_of(result.verdict))));
  html += asked.drawing_zone.empty() ? std::string("<td></td></tr>")
                                     : fmt::format(R"(<td data-l="{}">{}</td></tr>)", tr("Zone"),
                                                   isolated(asked.drawing_zone));
  std::string words = opening_sentence(result.reason);
  if (result.outcome) words += risks_in_words(result);
  if (const std::string own = own_rule_in_words(asked); !own.empty())
    words += "<br/>" + trf("Decision rule of this line: {}", escaped(own));
  if (result.value && result.value->uncertainty().result()) {
    const evaluation::UncertaintyResult& found = *result.value->uncertainty().result();
    for (const bool covered : {true, false}) {
      const std::string names = influences_in_words(
          found, covered, [](const std::string& name) { return worded(core::Phrase(name)); });
      if (!names.empty()) {
        words += "<br/>" + (covered ? trf("In the interval: {}", names)
                                    : trf("Not in the interval: {}", names));
      }
    }
  }
  if (result.value)
    words += "<br/>" + trf("Verification operator: {}", in_sentence(result.value->operator_text()));
  return html + R"(<tr class="words"><td colspan="6">)" + words + "</td></tr>";
}

std::string results_table(const evaluation::Evaluation& evaluation) {
  std::string rows;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics)
      rows += row(feature, result);
  }
  if (rows.empty()) return fmt::format("<p>{}</p>", tr("No characteristic was asked for."));
  return fmt::format(
             R"(<table class="results">{}<thead><tr><th scope="col">{}</th><th scope="col" class="n">{}</th>)"
             R"(<th scope="col" class="n">{}</th><th scope="col">{}</th><th scope="col">{}</th><th scope="col">{}</th></tr></thead><tbody>)",
             spoken_caption(tr("Result")), tr("Characteristic"), tr("Value"), tr("Limit"),
             tr("Value against limit"), tr("Verdict"), tr("Zone")) +
         rows + "</tbody></table>";
}

}  // namespace

std::string entry(std::string_view name, std::string_view html, std::string_view css_class) {
  if (css_class.empty()) return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, html);
  return fmt::format(R"(<div class="{}"><dt>{}</dt><dd>{}</dd></div>)", css_class, name, html);
}

std::string fact(std::string_view name, const std::string& text) {
  return text.empty() ? std::string() : entry(name, isolated(text));
}

std::string head_section(const record::RunRecord& record, const std::string& kind) {
  const record::Header& header = record.header;
  std::string html = fmt::format(
      R"(<header><div class="brand"><span><b>RONDURE</b> {}</span><span>{}</span></div>)", kind,
      isolated(header.started_utc));
  html += fmt::format("<h1>{}", isolated(header.part_id));
  if (!header.part_name.empty()) html += fmt::format(" {}", isolated(header.part_name));
  html += R"(</h1><dl class="facts">)";
  html += fact(tr("Serial"), header.serial) + fact(tr("Drawing"), header.drawing) +
          fact(tr("Plan"), header.plan_name) + fact(tr("Revision"), header.plan_revision) +
          fact(tr("Operator"), header.operator_name) + fact(tr("Run"), header.run_id);
  return html + "</dl></header>";
}

std::string verdict_lines(const evaluation::FeatureResult& feature) {
  std::string html;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    const record::Characteristic& asked = result.characteristic;
    std::string text = trf("{}: {} {}", isolated(asked.id), tr(evaluation::symbol_of(asked)),
                           result.value ? in_sentence(result.value->value_text()) : tr("no value"));
    if (asked.toleranced()) text += trf(", limit {}", limits_of(asked, tr(", ")));
    html += fmt::format(R"(<li>{} <b class="{}">{}</b> {}</li>)", verdict_mark(result.verdict, 18),
                        css_name(result.verdict), capitalised(tr(name_of(result.verdict))), text);
  }
  return html.empty() ? html : R"(<ul class="verdicts">)" + html + "</ul>";
}

std::string verdict_section(const record::RunRecord& record,
                            const evaluation::Evaluation& evaluation) {
  const evaluation::Verdict verdict = evaluation.verdict;
  std::string html = "<section>";
  html += unfinished_banner(record, evaluation);
  html += fmt::format(
      R"(<div class="verdict">{}<div><div class="word {}" role="heading" aria-level="2">{}</div><div class="why">{}</div>)"
      "</div></div>",
      verdict_mark(verdict, 76), css_name(verdict),
      incomplete_headline(record, evaluation).value_or(capitalised(tr(name_of(verdict)))),
      sentence(evaluation));
  if (record.header.simulated) {
    html += fmt::format(R"(<div class="banner"><b>{}</b> {}</div>)", tr("Simulated:"),
                        tr("no real part was measured."));
  }
  html += results_table(evaluation);
  return html + rule_section(evaluation) + "</section>";
}

}  // namespace rondure::reports
