#include "reports/terminal/summary.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/data/analyses.h"
#include "reports/escaping.h"
#include "reports/terminal/internal/columns.h"
#include "reports/words/callouts.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

/// A line of the terminal's summary: at most 13 characters of name, then text.
struct SummaryLine {
  std::string name;
  core::Phrase text;
};

using core::um;

std::vector<SummaryLine> lines_of(const evaluation::SpindleResult& facts) {
  const fit::ThreeProbeResult& s = facts.separation;
  std::vector<SummaryLine> out;
  std::string part;
  for (const fit::Roundness& value : facts.roundness.values) {
    std::string name(fit::name_of(value.reference));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(c - 'a' + 'A'); });
    part += fmt::format("{}{}CI {} um", part.empty() ? "RONt " : ", ", name, um(value.total_mm));
  }
  out.push_back({"part", core::phrase("{}; {}", core::as_it_is(part), filter_text(facts))});
  const auto direction = [](const char* name, const fit::AxisMotion& m) {
    if (!m.asynchronous_mm) {
      return core::phrase("{}: total {} um, synchronous {} um", name, um(m.total_mm),
                          um(m.synchronous_mm));
    }
    return core::phrase("{}: total {} um, synchronous {} um, asynchronous {} um", name,
                        um(m.total_mm), um(m.synchronous_mm), um(*m.asynchronous_mm));
  };
  out.push_back({"motion", joined(direction("X", facts.x), direction("Y", facts.y))});
  out.push_back({"eccentricity", core::phrase("{} um", um(s.eccentricity_mm))});
  const fit::WorstGain worst = fit::worst_gain(s.layout, 2, s.harmonics.back().order);
  out.push_back({"noise gain",
                 core::phrase("at most {:.2f}, at harmonic {}; profile known to {} um (rms, one "
                              "standard uncertainty)",
                              worst.gain, worst.order, um(s.profile_sigma_mm))});
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  std::vector<SummaryLine> out = {
      {"wheel", core::phrase("R {:.6f} mm, u(R) {} um, PV {} um, centre ({:.6f}, {:.6f}) mm",
                             m.radius_mm, um(m.radius_uncertainty_mm), um(m.deviation_mm),
                             m.center_mm.x(), m.center_mm.y())}};
  if (m.runout) {
    const core::Phrase& bound = m.runout->bound_because;
    out.push_back(
        {"run-out", bound.empty()
                        ? core::phrase("{} um; effective radius {:.6f} mm", um(m.runout->fim_mm),
                                       m.runout->effective_radius_mm)
                        : core::phrase("at least {} um as read: {}", um(m.runout->fim_mm), bound)});
  }
  if (m.runout) {
    if (core::Phrase stated = effective_radius_in_words(facts); !stated.empty())
      out.push_back({"eff. radius", std::move(stated)});
  }
  const auto& e = facts.evaluation;
  if (e.path) {
    out.push_back(
        {"path", core::phrase("{} places, R k_s at most {:.4f}, PV left {} um", e.path->rows.size(),
                              e.path->load.load, um(e.forecast->measured.deviation_mm))});
  }
  if (e.refused) out.push_back({"no path", e.refused->said()});
  return out;
}

/// Peak to valley of a curve of a part, with its interval where there is one.
std::string peak_to_valley_of(const evaluation::ContourResult& facts,
                              evaluation::ContourNumber::Curve curve, std::size_t part,
                              double as_measured_mm) {
  using Number = evaluation::ContourNumber;
  for (const Number& number : facts.numbers) {
    if (number.curve == curve && number.part == part && number.kind == Number::Kind::kPeakToValley)
      return with_interval(number, "<=");
  }
  return um(as_measured_mm);
}

std::vector<SummaryLine> lines_of(const evaluation::ContourResult& facts) {
  using Curve = evaluation::ContourNumber::Curve;
  std::vector<SummaryLine> out;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const fit::ContourPartResult& part = facts.study.parts[i];
    const std::string t =
        peak_to_valley_of(facts, Curve::kTotal, i, part.pin.contour.peak_to_valley_mm);
    const std::string f =
        peak_to_valley_of(facts, Curve::kFollowing, i, part.following.peak_to_valley_mm);
    const std::string n =
        peak_to_valley_of(facts, Curve::kRest, i, fit::peak_to_valley(part.direct.rest_mm));
    out.push_back(
        {"part",
         part.traced
             ? core::phrase("{}: contour {} um PV; following {} um, not following {} um",
                            facts.names[i], t, f, n)
             : core::phrase("{}: contour {} um PV; by the main journal {} um following, {} um not",
                            facts.names[i], t, f, n)});
  }
  if (const auto& gain = facts.gain) {
    out.push_back(
        {"corrected", core::phrase("mean f {} um PV; without the correction, feature {}: {} um",
                                   um(fit::peak_to_valley(fit::mean_following(facts.study))),
                                   gain->with, um(gain->before_mm))});
  }
  bool first = true;
  for (const core::Phrase& verdict : contour_verdicts(facts.study)) {
    out.push_back({std::exchange(first, false) ? "stability" : "", verdict});
  }
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::RotaryResult& facts) {
  const fixture::Verification& v = facts.calibration.verification;
  std::vector<SummaryLine> out = {
      {"fixture", core::phrase("{}, valid until {}", facts.calibration.fixture_id,
                               facts.calibration.expires_utc)},
      {"before",
       core::phrase("{} um rms, {} um at most", um(v.before_rms_mm), um(v.before_max_mm))},
      {"compensated", core::phrase("{} um rms, {} um at most; {} um rms expected", um(v.rms_mm),
                                   um(v.max_mm), um(v.expected_mm))}};
  return out;
}

std::vector<SummaryLine> lines_of(const evaluation::FiveAxisResult& facts) {
  const fit::HeadRms before = facts.gain ? facts.gain->before : facts.study.before;
  const double expected_mm = facts.gain ? facts.gain->forecast_mm : facts.study.expected_mm;
  return {
      {"before", core::phrase("{} um rms, {} um at most", um(before.rms_mm), um(before.max_mm))},
      {"compensated",
       core::phrase("{} um rms, {} um at most; {} um rms expected", um(facts.left().rms_mm),
                    um(facts.left().max_mm), um(expected_mm))}};
}

/// The summary lines of an analysis, in English.
std::vector<SummaryLine> summary_lines(const evaluation::AnalysisResult& result) {
  return std::visit([](const auto& found) { return lines_of(found); }, result.found);
}

using core::fixed;
using core::printable;
using core::signed_um;
using core::tiny_um;

constexpr std::size_t kValueColumn = 15;  ///< Start of the values in labelled lines.

/// Appends a line of the summary; `head` has kValueColumn columns or less.
void add_wrapped(std::string& out, std::string_view head, std::string_view text) {
  out += wrapped(padded(head, kValueColumn), text, LineBreaks::kAtWideCharacters);
}

/// Words of evaluation in the language of the report, else in English.
std::string words(const core::Phrase& phrase) {
  return in_words(phrase).value_or(phrase.english());
}

/// An error of another room: the title of its code, then its sentence.
std::string line_of(core::Error error) {
  error.what = words(error.said());
  return titled(error.code) + core::to_line(error);
}

/// A call-out by the name that the plan gives it.
std::string callout_in_text(const Callout& callout) {
  return trf("{0} of {1}", printable(callout.result->characteristic.id),
             printable(callout.feature->feature.id));
}

void add_plain(std::string& out, std::string_view text) {
  out += wrapped("", text, LineBreaks::kAtWideCharacters);
}

/// The count, remarks on all values, and why the run did not finish.
void add_head(std::string& out, const record::RunRecord& record,
              const evaluation::Evaluation& evaluation, const std::vector<Callout>& callouts) {
  const auto carries_verdict = [&](const Callout& callout) {
    return callout.result->verdict == evaluation.verdict;
  };
  if (const auto incomplete = incomplete_headline(record, evaluation)) {
    add_plain(out, *incomplete);
  } else if (std::ranges::none_of(callouts, carries_verdict)) {
    add_plain(out, capitalised(tr(name_of(evaluation.verdict))));  // of a feature without a result
  }
  add_plain(out, answer_in_words(callouts, callout_in_text));
  for (const auto& [word, text] : remarks_on(record, callouts)) add_plain(out, word + " " + text);
  if (record.ending == "finished") return;
  add_wrapped(out, tr("not finished"),
              record.ending.empty() ? tr("the run has no end on record")
                                    : words(core::Phrase(record.ending)));
  if (record.failure) add_wrapped(out, tr("reason"), line_of(*record.failure));
  for (const std::string& part_missing : missing_parts(record, evaluation)) {
    add_wrapped(out, tr("missing"), part_missing);
  }
}

void add_origin(std::string& out, const record::Header& header,
                const evaluation::Evaluation& evaluation) {
  const auto rule = rule_sentence(evaluation);
  add_wrapped(out, tr("rule"), rule ? *rule : evaluation.rule.error().what);
  std::string part = header.part_id;
  for (const std::string& more : {header.part_name, header.drawing}) {
    if (!more.empty()) part += ", " + more;
  }
  if (!header.serial.empty()) part += trf(", serial {}", header.serial);
  add_wrapped(out, tr("part"), part);
  add_wrapped(out, tr("run"), header.run_id);
}

/// A column of the call-outs, as wide as its widest cell.
struct Column {
  std::string head;
  bool right = false;
  int spared = 0;  ///< Left out as the n-th where the lines are too long; 0: never.
  std::vector<std::string> cells = {};
  std::size_t width = 0;
};

std::vector<Column> columns_of(const std::vector<Callout>& callouts) {
  std::vector<Column> out = {{tr("Feature")},
                             {tr("Call-out")},
                             {tr("Characteristic"), false, 1},
                             {tr("Value"), true},
                             {"U", true},
                             {""},
                             {tr("Limit"), true},
                             {tr("Share"), true, 3},
                             {tr("Worst at"), false, 2}};
  for (const Callout& one : callouts) {
    const record::Characteristic& asked = one.result->characteristic;
    const std::array<std::string, 9> cells = {
        printable(one.feature->feature.id),
        printable(asked.id),
        fmt::format("{} {}", one.symbol, evaluation::reference_of(asked)),
        one.value.empty() ? tr("no value") : one.value,
        one.expanded,
        std::string(core::sign_of(one.unit)),
        one.limit,
        one.share_1 ? fixed(100.0 * *one.share_1, 0) + " %" : "",
        one.place};
    for (std::size_t i = 0; i < out.size(); ++i) out[i].cells.push_back(cells[i]);
  }
  std::erase_if(out, [](const Column& column) {
    const bool names = !column.right && column.spared == 0;
    return !names && std::ranges::all_of(column.cells, &std::string::empty);
  });
  for (Column& column : out) {
    column.width = columns(column.head);
    for (const std::string& cell : column.cells)
      column.width = std::max(column.width, columns(cell));
  }
  return out;
}

/// Leaves out what a reader can best do without, then shortens names, until a line fits.
void fit_into_line(std::vector<Column>& table) {
  const auto too_wide = [&table] {
    std::size_t sum = 0;
    for (const Column& column : table) sum += column.width + 2;
    return sum > kTerminalColumns;
  };
  for (int next = 1; next <= 3 && too_wide(); ++next)
    std::erase_if(table, [next](const Column& column) { return column.spared == next; });
  constexpr std::size_t kLeastName = 6;
  while (too_wide()) {
    Column& name = table[0].width > table[1].width ? table[0] : table[1];
    if (name.width <= kLeastName) return;
    --name.width;
  }
}

/// The call-outs below their verdicts, a line each.
void add_table(std::string& out, const std::vector<Callout>& callouts) {
  if (callouts.empty()) return;
  std::vector<Column> table = columns_of(callouts);
  fit_into_line(table);
  const auto add_row = [&](const auto& cell_of) {
    std::string line;
    for (const Column& column : table) {
      const std::string cell = shortened(cell_of(column), column.width);
      const std::string space(column.width - columns(cell), ' ');
      line += "  " + (column.right ? space + cell : cell + space);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += shortened(line, kTerminalColumns) + "\n";
  };
  out += "\n";
  add_row([](const Column& column) { return column.head; });
  for (std::size_t i = 0; i < callouts.size(); ++i) {
    const evaluation::Verdict verdict = callouts[i].result->verdict;
    if (i == 0 || callouts[i - 1].result->verdict != verdict)
      out += capitalised(tr(name_of(verdict))) + "\n";
    add_row([i](const Column& column) { return column.cells[i]; });
  }
}

/// The interval of a value, its bias and the largest influence.
void add_uncertainty(std::string& out, const evaluation::StatedValue& value) {
  const evaluation::UncertaintyResult& u = *value.uncertainty().result();
  const std::string unit(name_of(value.unit()));
  const auto line = [&](const std::string& name, const evaluation::UncertaintyStatement& s) {
    const auto number = [&](double mm) {
      return core::length_in(value.unit(), mm, evaluation::decimals_for(s.expanded_mm()));
    };
    if (s.at_most) {
      add_wrapped(out, name,
                  trf("at most {} {} {}; noise and influences make up too much of it for a value",
                      number(s.high_mm), unit, tr(name_of(s.measurand))));
      return;
    }
    if (value.bound() == evaluation::StatedValue::Bound::kLower) {
      add_wrapped(out, name,
                  trf("at least {} {} {}; the points may miss more of it", number(s.low_mm), unit,
                      tr(name_of(s.measurand))));
      return;
    }
    add_wrapped(out, name,
                trf("{} {}, {:g} % within [{}, {}] {} {}", number(s.estimate_mm), unit,
                    100.0 * value.uncertainty().coverage_1(), number(s.low_mm), number(s.high_mm),
                    unit, tr(name_of(s.measurand))));
  };
  line("    " + tr("corrected"), u.sampled);
  if (u.whole) line("", *u.whole);
  std::string bias = trf("noise {}", fmt::format("{} {}", signed_um(u.noise_inflation_mm),
                                                 name_of(core::unit_of_difference(value.unit()))));
  if (u.sampling_loss_mm) bias += trf(", sparse sampling {} um", signed_um(*u.sampling_loss_mm));
  const auto most = std::find_if(
      u.budget.begin(), u.budget.end(),
      [&](const evaluation::BudgetLine& one) { return one.measurand == value.measurand(); });
  if (most != u.budget.end() && most->share_1 > 0.0) {
    bias += trf("; most of the spread {}: {} ({:.0f} %)", tr(name_of(most->measurand)),
                tr(most->name), 100.0 * most->share_1);
  }
  add_wrapped(out, "    " + tr("bias"), bias);
  for (const core::Phrase& note : u.notes) add_wrapped(out, "    " + tr("note"), words(note));
}

/// "layer 3 at 12.000 mm", "generatrix at 90.0 deg", "circle of radius 20.000 mm".
std::string place_of(const evaluation::LocalValue& local) {
  using Place = evaluation::LocalValue::Place;
  if (local.place == Place::kLayer)
    return trf("layer {} at {} mm", local.layer + 1, fixed(local.position, 3));
  return local.place == Place::kAngle ? trf("generatrix at {} deg", core::deg(local.position, 1))
                                      : trf("circle of radius {} mm", fixed(local.position, 3));
}

/// The judged values where there are several, the worst section, rocking datums, points that take
/// no part, warnings.
/// @param said  Notes of the feature on points without a filter: each is said once.
void add_finding(std::string& out, const evaluation::Finding& finding,
                 const evaluation::StatedValue& stated, std::set<std::string>& said) {
  const auto number = [&](double length_mm) {
    return fmt::format("{} {}", stated.in_digits(length_mm), name_of(stated.unit()));
  };
  if (finding.judged.size() > 1) {
    std::string text;
    for (const evaluation::JudgedValue& value : finding.judged) {
      text += fmt::format("{}{} {}", text.empty() ? "" : tr("; "), value.symbol,
                          number(value.value_mm));
    }
    add_wrapped(out, "    " + tr("values"), text);
  }
  if (finding.local.size() > 1 && finding.worst < finding.local.size()) {
    const evaluation::LocalValue& worst = finding.local[finding.worst];
    const std::string least = worst.least_mm ? number(*worst.least_mm) + tr(" to ") : "";
    add_wrapped(out, "    " + tr("worst"),
                trf("{}: {}, one of {}", place_of(worst), least + number(worst.value_mm),
                    finding.local.size()));
  }
  std::size_t missing = 0;
  const evaluation::LocalValue* first = nullptr;
  for (const evaluation::LocalValue& local : finding.local) {
    if (!local.none) continue;
    if (first == nullptr) first = &local;
    ++missing;
  }
  if (first != nullptr) {
    add_wrapped(out, "    " + tr("no value"),
                trf("{} of {}: {}: {}", missing, finding.local.size(), place_of(*first),
                    words(first->none->said())));
  }
  constexpr double kPlay_mm = core::kMicrometre;  // less is that of every real surface
  for (const evaluation::DatumResult& datum : finding.datums) {
    if (!(datum.play_mm > kPlay_mm)) continue;
    std::string text = trf("datum {} rocks by {} um", datum.name, um(datum.play_mm));
    if (!finding.about_equalised_mm.empty()) {
      text += trf("; {} about the equalised datum", number(finding.about_equalised_mm.front()));
    }
    add_wrapped(out, "    " + tr("warning"), text);
  }
  if (!finding.left_out.empty()) {
    std::map<std::string, std::size_t> why;
    for (const evaluation::LeftOut& row : finding.left_out)
      ++why[row.window.empty() ? tr("outlier rule") : printable(row.window)];
    std::string text;
    for (const auto& [name, rows] : why)
      text += fmt::format("{}{} {}", text.empty() ? "" : tr(", "), name, rows);
    add_wrapped(out, "    " + tr("left out"), trf("{} points: {}", finding.left_out.size(), text));
  }
  for (const core::Error& warning : finding.warnings) {
    if (warning.code == core::Code::kUnfiltered && !said.insert(warning.what).second) continue;
    add_wrapped(out, "    " + tr("warning"), line_of(warning));
  }
}

/// "  CYLt MZCY    id: does not conform", then what the line of the table does not say.
void add_characteristic(std::string& out, const evaluation::CharacteristicResult& result,
                        std::set<std::string>& said) {
  const record::Characteristic& asked = result.characteristic;
  add_wrapped(
      out,
      fmt::format("  {} {}", tr(evaluation::symbol_of(asked)), evaluation::reference_of(asked)),
      trf("{}: {}", printable(asked.id), tr(name_of(result.verdict))));
  const bool simple = result.value && !result.value->uncertainty().result();
  if (result.verdict == evaluation::Verdict::kVoid ||
      result.verdict == evaluation::Verdict::kUndecided || (!simple && result.outcome)) {
    add_wrapped(out, "    " + tr("because"), words(result.reason));
  }
  if (const std::string own = own_rule_in_words(asked); !own.empty())
    add_wrapped(out, "    " + tr("rule"), own);
  if (result.value) add_wrapped(out, "    " + tr("stated"), words(result.value->sentence()));
  if (!simple && result.value) add_uncertainty(out, *result.value);
  if (result.finding && result.value) add_finding(out, *result.finding, *result.value, said);
}

void add_zone(std::string& out, const evaluation::FeatureResult& feature) {
  const auto zone = zone_of(feature);
  if (!zone) return;
  add_wrapped(
      out, "  " + tr("zone"),
      trf("radii {} and {} mm {}", fixed(zone->inner_radius_mm, 4), fixed(zone->outer_radius_mm, 4),
          zone->of_surface ? tr("of the surface") : tr("of the points, tip unknown")));
  const fit::Certificate& certificate = zone->certificate;
  std::string text = tr(fit::name_of(certificate.kind));
  if (!certificate.scope.empty()) text += tr(", ") + words(certificate.scope);
  if (certificate.kind != fit::Certificate::Kind::kNone) {
    text += trf(", gap {} um", tiny_um(certificate.gap_mm));
  }
  if (!certificate.reason.empty()) text += tr("; ") + words(certificate.reason);
  add_wrapped(out, "  " + tr("certificate"), text);
}

/// "MCCY radius 25.0052 mm, CYLt 8.812 um; MICY ..."; a reference that does not exist gives a
/// warning instead.
void add_one_sided(std::string& out, const evaluation::FeatureResult& feature) {
  using record::Reference;
  const record::Shape shape = feature.feature.shape;
  std::string text;
  for (const Reference reference :
       {Reference::kMinimumCircumscribed, Reference::kMaximumInscribed}) {
    const auto found = one_sided_of(feature, reference);
    if (!found) continue;
    if (!text.empty()) text += tr("; ");
    text += trf("{} radius {} mm, {} {} um", evaluation::reference_of(reference, shape),
                fixed(found->radius_mm, 4), evaluation::symbol_of(shape), um(found->deviation_mm));
    if (found->certificate.kind != fit::Certificate::Kind::kGlobal) {
      text += tr(", ") + tr("certificate") + " " + tr(fit::name_of(found->certificate.kind));
    }
  }
  if (!text.empty()) add_wrapped(out, "  " + tr("one-sided"), text);
}

/// "held against the truth  CYLt 8: truth 8.202 um, difference +0.052 um, 0.3 u".
void add_truth(std::string& out, const evaluation::FeatureResult& feature) {
  for (const HeldAgainstTruth& one : held_against_truth(feature)) {
    std::string text = trf("{}: truth {} {}, difference {} {}", printable(one.name),
                           one.found.in_digits(one.truth_mm), core::name_of(one.found.unit()),
                           signed_um(one.difference_mm()),
                           core::name_of(core::unit_of_difference(one.found.unit())));
    if (const auto over_u = one.difference_over_u()) text += fmt::format(", {:.1f} u", *over_u);
    add_wrapped(out, "  " + tr("simulated"), text);
  }
}

/// "spool: outside cylinder, 4 x 7 points", "journal: spindle, 3 revolutions".
std::string heading_of(const evaluation::FeatureResult& feature) {
  const std::string name = shortened(printable(feature.feature.id), 30);
  if (record::is_analysis(feature.feature.shape)) {
    const std::string shape = tr(record::name_of(feature.feature.shape));
    return feature.analysis
               ? trf("{}: {}, {}", name, shape, words(sampling_text(*feature.analysis)))
               : trf("{}: {}", name, shape);
  }
  return trf("{}: {} {}, {}", name, tr(record::name_of(feature.feature.side)),
             tr(record::name_of(feature.feature.shape)), pattern_of(feature));
}

/// "no interval  RONt, RONq: no influence of the probes is declared".
void add_absent_intervals(std::string& out, const evaluation::FeatureResult& feature) {
  for (const AbsentInterval& absent : absent_intervals(feature)) {
    std::string names;
    for (const std::string& id : absent.ids)
      names += (names.empty() ? "" : tr(", ")) + printable(id);
    add_wrapped(out, "  " + tr("no interval"), trf("{}: {}", names, words(absent.why)));
  }
}

/// "gates  7 of 8 passed; first-harmonic: ..." where one did not pass; JSON and page list all.
void add_gates(std::string& out, const evaluation::FeatureResult& feature) {
  using evaluation::Gate;
  const bool passed = std::ranges::all_of(
      feature.gates, [](const Gate& gate) { return gate.outcome == Gate::Outcome::kPassed; });
  if (!passed) add_wrapped(out, "  " + tr("gates"), in_words(feature.gates));
}

void add_analysis(std::string& out, const record::RunRecord& record, std::size_t index,
                  const evaluation::FeatureResult& feature) {
  if (feature.analysis) {
    for (const SummaryLine& line : summary_lines(*feature.analysis))
      add_wrapped(out, fmt::format("  {}", tr(line.name)), words(line.text));
  }
  for (const record::TruthValue& truth : record.truth_values) {
    if (static_cast<std::size_t>(truth.feature) != index) continue;
    add_wrapped(out, "  " + tr("hidden truth"),
                trf("{} (of the simulation, not of the measurement)",
                    fmt::format("{} {:.6g}", words(core::Phrase(truth.name)), truth.value)));
  }
}

bool conforms(const evaluation::CharacteristicResult& result) {
  using evaluation::Verdict;
  return result.verdict == Verdict::kConforms || result.verdict == Verdict::kNotToleranced;
}

/// @param all  False: only the call-outs that do not conform, and why there is no result.
void add_details(std::string& out, const record::RunRecord& record, std::size_t index,
                 const evaluation::FeatureResult& feature, const std::vector<Callout>& callouts,
                 bool all) {
  if (!all && !feature.failure && std::ranges::all_of(feature.characteristics, conforms)) return;
  out += "\n";
  add_wrapped(out, tr("feature"), heading_of(feature));
  std::set<std::string> said;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    if (!all && conforms(result)) continue;
    add_characteristic(out, result, said);
    const auto callout = std::ranges::find(callouts, &result, &Callout::result);
    if (!callout->place.empty()) add_wrapped(out, "    " + tr("worst at"), callout->place);
    for (core::Error warning : feature.warnings) {
      if (std::exchange(warning.where, "") != result.characteristic.id) continue;
      add_wrapped(out, "    " + tr("warning"), line_of(std::move(warning)));
    }
  }
  if (feature.failure) add_wrapped(out, "  " + tr("no result"), line_of(*feature.failure));
  if (!all) return;
  add_absent_intervals(out, feature);
  add_analysis(out, record, index, feature);
  add_gates(out, feature);
  add_zone(out, feature);
  add_one_sided(out, feature);
  add_truth(out, feature);
  for (const core::Error& warning : feature.warnings) {
    const auto stands = [&](const evaluation::CharacteristicResult& result) {
      return result.characteristic.id == warning.where;
    };
    if (std::ranges::any_of(feature.characteristics, stands)) continue;
    add_wrapped(out, "  " + tr("warning"), line_of(warning));
  }
}

std::string terminal_text(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                          Language language, bool all) {
  const LanguageScope scope(language);
  const std::vector<Callout> callouts = callouts_of(evaluation);
  std::string out;
  add_head(out, record, evaluation, callouts);
  if (all) add_origin(out, record.header, evaluation);
  add_table(out, callouts);
  for (std::size_t i = 0; i < evaluation.features.size(); ++i)
    add_details(out, record, i, evaluation.features[i], callouts, all);
  out += "\n";
  add_plain(out, uncertainty_in_words(callouts, words));
  return with_signs(out);
}

}  // namespace

std::string write_answer(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                         Language language) {
  return terminal_text(record, evaluation, language, false);
}

std::string write_summary(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                          Language language) {
  return terminal_text(record, evaluation, language, true);
}

std::string write_whereabouts(std::string_view report, std::string_view next, Language language) {
  const LanguageScope scope(language);
  return next.empty() ? trf("Report: {}", report) : trf("Report: {}; next: {}", report, next);
}

}  // namespace rondure::reports
