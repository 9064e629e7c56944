#include <algorithm>

#include <fmt/format.h>

#include "reports/facts.h"
#include "reports/html_sections.h"
#include "reports/text.h"

namespace rondure::reports {
namespace {

constexpr std::size_t kMostDecisions = 60;
constexpr std::size_t kEndDecisions = 20;

std::string property(std::string_view name, const std::string& html) {
  return fmt::format(R"(<tr><th scope="row">{}</th><td>{}</td></tr>)", name, html);
}

std::string mono(const std::string& text) {
  return fmt::format(R"(<span class="mono">{}</span>)", escaped(text));
}

std::string text_or_dash(const std::string& text) { return text.empty() ? "–" : isolated(text); }

std::string decision_row(const record::RunRecord& record, const record::Decision& decision) {
  const auto index = static_cast<std::size_t>(decision.feature);
  const bool known = decision.feature >= 0 && index < record.features.size();
  return fmt::format(R"(<tr><td class="n">{}</td><td>{}</td><td>{}</td></tr>)",
                     fixed(decision.time_s, 1), known ? isolated(record.features[index].id) : "run",
                     in_sentence(decision.text));
}

std::string qualification_rows(const record::RunRecord& record, const fit::ProbeTip& tip) {
  const record::Artefact& artefact = record.artefact;
  return property("Effective tip radius",
                  fmt::format("{} mm, standard deviation {} µm; nominal {} mm, limit ± {} µm",
                              fixed(tip.radius_mm, 6), um(tip.radius_sigma_mm),
                              fixed(artefact.nominal_tip_radius_mm, 6),
                              um(artefact.radius_tolerance_mm))) +
         property("Probing form",
                  fmt::format("{} µm, limit {} µm", um(tip.form_mm), um(artefact.form_limit_mm))) +
         property(
             "Reference sphere",
             fmt::format("radius {} mm, found at ({}, {}, {}) mm", fixed(artefact.radius_mm, 6),
                         fixed(tip.sphere_center_mm.x(), 6), fixed(tip.sphere_center_mm.y(), 6),
                         fixed(tip.sphere_center_mm.z(), 6)));
}

std::string calibration_row(const std::optional<FixtureUse>& use) {
  if (!use) return {};
  std::string text = fmt::format(
      "{}, measured {}, valid until {}{}; left at combined poses {} µm rms, {} µm at most, {} µrad",
      isolated(use->id), escaped(use->measured_utc), escaped(use->expires_utc),
      use->age_days ? fmt::format(", {} days old at the start of the run", fixed(*use->age_days, 1))
                    : std::string(),
      um(use->residual_rms_mm), um(use->residual_max_mm), fixed(use->residual_tilt_rad * 1e6, 1));
  if (use->invalid) text += "; <b>it does not hold:</b> " + in_sentence(use->invalid->what);
  return property("Calibration of the fixture", text);
}

}  // namespace

std::string probe_section(const record::RunRecord& record, const Evaluation& evaluation) {
  const record::Header& header = record.header;
  std::string rows = property("Machine", text_or_dash(header.machine)) +
                     property("Fixture", text_or_dash(header.fixture)) +
                     calibration_row(evaluation.fixture);
  if (header.temperature_max_degC > header.temperature_min_degC) {
    rows += property("Temperature limits", fmt::format("{} to {} °C; outside them a result is void",
                                                       fixed(header.temperature_min_degC, 1),
                                                       fixed(header.temperature_max_degC, 1)));
  }
  if (evaluation.probe) {
    rows += qualification_rows(record, *evaluation.probe);
  } else {
    rows += property("Probe qualification", "none on record");
  }
  return R"(<section><h2>Settings and probe</h2><table class="short props">)" + rows +
         "</table></section>";
}

std::string decisions_section(const record::RunRecord& record) {
  if (record.decisions.empty()) return {};
  std::string html =
      R"(<section><h2>Decisions of the program</h2><table><thead><tr><th class="n">Machine time / s)"
      "</th><th>Feature</th><th>Decision</th></tr></thead><tbody>";
  const std::size_t total = record.decisions.size();
  const bool all = total <= kMostDecisions;
  for (std::size_t i = 0; i < total; ++i) {
    if (!all && i == kEndDecisions) {
      html += fmt::format(R"(<tr><td class="n">…</td><td></td><td>{} left out; report.json has all)"
                          "</td></tr>",
                          count(total - 2 * kEndDecisions, "decision", "decisions"));
    }
    if (all || i < kEndDecisions || i + kEndDecisions >= total) {
      html += decision_row(record, record.decisions[i]);
    }
  }
  return html + "</tbody></table></section>";
}

std::string provenance_section(const record::RunRecord& record) {
  const record::Header& header = record.header;
  std::string rows = property("Run", text_or_dash(header.run_id)) +
                     property("Started (UTC)", text_or_dash(header.started_utc)) +
                     property("Ending", text_or_dash(record.ending)) +
                     property("Touches on record", std::to_string(record.touches.size())) +
                     property("Rondure", text_or_dash(header.version)) +
                     property("Processor", text_or_dash(header.processor)) +
                     property("Plan file", text_or_dash(header.plan_file)) +
                     property("Plan SHA-256", mono(header.plan_sha256));
  for (const record::Feature& feature : record.features) {
    if (feature.points_file.empty()) continue;
    rows += property("Points file",
                     isolated(feature.points_file) + "<br/>" + mono(feature.points_sha256));
  }
  if (header.simulated) rows += property("Seed of the simulation", std::to_string(header.seed));
  rows += property("Decision rule", isolated(rule_in_words(header)));
  rows += property("To verify",
                   R"(<span class="mono">rondure verify RUN_DIR</span> computes every number here )"
                   "again from the touches in journal.db and says which digit differs, if any.");
  return R"(<section><h2>Provenance</h2><table class="props">)" + rows + "</table></section>";
}

}  // namespace rondure::reports
