
#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "record/tasks/settings.h"
#include "reports/escaping.h"
#include "reports/history/earlier_results.h"
#include "reports/history/history.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::um;

constexpr std::size_t kMostDecisions = 60;
constexpr std::size_t kEndDecisions = 20;

std::string property(std::string_view name, const std::string& html) {
  return fmt::format(R"(<tr><th scope="row">{}</th><td>{}</td></tr>)", name, html);
}

std::string mono(const std::string& text) {
  return fmt::format(R"(<span class="mono">{}</span>)", escaped(text));
}

std::string text_or_dash(const std::string& text) { return text.empty() ? "–" : isolated(text); }

/// The same for a text of the program.
std::string words_or_dash(const std::string& text) {
  return text.empty() ? "–" : worded(core::Phrase(text));
}

/// A sentence with a reason that the language does not know stays in English.
std::string decision_html(const record::Decision& decision) {
  const std::string english = english_sentence(decision.message);
  return in_sentence(language() == Language::kEnglish ? english : in_words(decision.message),
                     english);
}

std::string artefact_row(double radius_mm, const fit::ProbeTip& tip) {
  const Eigen::Vector3d& at = tip.sphere_center_mm;
  if (!tip.on_column()) {
    return property(tr("Reference sphere"),
                    trf("radius {} mm, found at ({}, {}, {}) mm", fixed(radius_mm, 6),
                        fixed(at.x(), 6), fixed(at.y(), 6), fixed(at.z(), 6)));
  }
  return property(tr("Reference column"),
                  trf("radius {} mm, axis through ({}, {}, {}) mm, {}° from upright",
                      fixed(radius_mm, 6), fixed(at.x(), 6), fixed(at.y(), 6), fixed(at.z(), 6),
                      fixed(tip.lean_rad() / core::kDegree, 3)));
}

std::string qualification_rows(const record::RunRecord& record, const fit::ProbeTip& tip) {
  const record::Artefact& artefact = record.artefact;
  return property(tr("Effective tip radius"),
                  trf("{} mm, standard deviation {} µm; nominal {} mm, limit ± {} µm",
                      fixed(tip.radius_mm, 6), um(tip.radius_sigma_mm),
                      fixed(artefact.nominal_tip_radius_mm, 6), um(artefact.radius_tolerance_mm))) +
         property(tr("Probing form"),
                  trf("{} µm, limit {} µm", um(tip.form_mm), um(artefact.form_limit_mm))) +
         artefact_row(artefact.radius_mm, tip);
}

std::string calibration_row(const std::optional<evaluation::FixtureUse>& use) {
  if (!use) return {};
  std::string text = trf(
      "{}, measured {}, valid until {}{}; left at combined poses {} µm rms, {} µm at most, {} µrad",
      isolated(use->id), escaped(use->measured_utc), escaped(use->expires_utc),
      use->age_days ? trf(", {} days old at the start of the run", fixed(*use->age_days, 1))
                    : std::string(),
      um(use->residual_rms_mm), um(use->residual_max_mm), fixed(use->residual_tilt_rad * 1e6, 1));
  if (use->invalid) {
    text += fmt::format("; <b>{}</b> {}{}", tr("it does not hold:"), titled(use->invalid->code),
                        in_sentence(use->invalid->said()));
  }
  return property(tr("Calibration of the fixture"), text);
}

}  // namespace

std::string probe_section(const record::RunRecord& record,
                          const evaluation::Evaluation& evaluation) {
  const record::Header& header = record.header;
  std::string rows = property(tr("Machine"), words_or_dash(header.machine)) +
                     property(tr("Fixture"), words_or_dash(header.fixture)) +
                     calibration_row(evaluation.fixture);
  if (header.temperature_max_degC > header.temperature_min_degC) {
    rows += property(tr("Temperature limits"), trf("{} to {} °C; outside them a result is void",
                                                   fixed(header.temperature_min_degC, 1),
                                                   fixed(header.temperature_max_degC, 1)));
  }
  if (evaluation.probe) {
    rows += qualification_rows(record, *evaluation.probe);
  } else {
    rows += property(tr("Probe qualification"), tr("none on record"));
  }
  return fmt::format(R"(<section><h2>{}</h2><table class="short props">{}{}</table></section>)",
                     tr("Settings and probe"), spoken_caption(tr("Settings and probe")), rows);
}

std::string decisions_section(const record::RunRecord& record) {
  if (record.decisions.empty()) return {};
  TableRows rows;
  const std::size_t total = record.decisions.size();
  const bool all = total <= kMostDecisions;
  for (std::size_t i = 0; i < total; ++i) {
    if (!all && i == kEndDecisions) {
      rows.push_back({"…", "",
                      trf("{} left out; report.json has all",
                          count(total - 2 * kEndDecisions, "decision", "decisions"))});
    }
    if (!all && i >= kEndDecisions && i + kEndDecisions < total) continue;
    const record::Decision& decision = record.decisions[i];
    const auto feature = static_cast<std::size_t>(decision.feature);
    const bool known = decision.feature >= 0 && feature < record.features.size();
    rows.push_back({fixed(decision.time_s, 1),
                    known ? isolated(record.features[feature].id) : tr("run"),
                    decision_html(decision)});
  }
  return fmt::format("<section><h2>{}</h2>{}</section>", tr("Decisions of the program"),
                     table("", "rll", spoken_caption(tr("Decisions of the program")),
                           {tr("Machine time / s"), tr("Feature"), tr("Decision")}, rows));
}

std::string provenance_section(const record::RunRecord& record) {
  const record::Header& header = record.header;
  std::string rows =
      property(tr("Run"), text_or_dash(header.run_id)) +
      property(tr("Started (UTC)"), text_or_dash(header.started_utc)) +
      property(tr("Ending"), words_or_dash(record.ending)) +
      property(tr("Touches on record"), std::to_string(record.touches.size())) +
      property("Rondure", text_or_dash(header.version)) +
      property(tr("Processor"), header.processor.empty() ? "–" : foreign(header.processor)) +
      property(tr("Plan file"), text_or_dash(header.plan_file)) +
      property(tr("Plan SHA-256"), mono(header.plan_sha256));
  for (const record::Feature& feature : record.features) {
    if (feature.points_file.empty()) continue;
    std::string html = isolated(feature.points_file) + "<br/>" + mono(feature.points_sha256);
    const auto source = record::task_of<record::SourceSettings>(feature.settings, "source/");
    if (source && source->read) html += "<br/>" + foreign(*source->read);
    rows += property(tr("Points file"), html);
  }
  if (header.simulated) rows += property(tr("Seed of the simulation"), std::to_string(header.seed));
  return fmt::format(R"(<section><h2>{}</h2><table class="props">{}{}</table></section>)",
                     tr("Provenance"), spoken_caption(tr("Provenance")), rows);
}

std::string history_section(const record::RunRecord& record,
                            const evaluation::Evaluation& evaluation,
                            const EarlierResults& earlier) {
  std::string html;
  for (const RunChart& chart : run_charts(record, evaluation, earlier)) {
    const record::ArchiveResult& result = chart.results.back().result;
    html += fmt::format(R"(<h3>{} · {}</h3><figure><div class="scroll">{}</div><figcaption>)",
                        isolated(result.characteristic),
                        trf("Feature {}", isolated(result.feature)), history_drawing(chart));
    if (const core::Phrase words = capability_in_words(chart); !words.empty()) {
      html += "<b>" + in_sentence(words) + "</b> ";
    }
    for (const core::Phrase& sentence : history_sentences(chart))
      html += in_sentence(sentence) + " ";
    html += "</figcaption></figure>";
  }
  if (html.empty()) return {};
  return fmt::format(
      R"(<section><h2>{}</h2><p class="note">{}</p>{}</section>)", tr("Earlier runs"),
      tr("Results of the same characteristics from the archive, as it was when this run was "
         "reported first; the last is this run."),
      html);
}

}  // namespace rondure::reports
