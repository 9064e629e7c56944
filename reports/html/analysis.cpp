#include <fmt/format.h>

#include "evaluation/analysis_result.h"
#include "reports/escaping.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

/// Numbers of the hidden truth, as a box that says what they are.
std::string truth_box(const record::RunRecord& record, std::size_t index) {
  std::string text;
  for (const record::TruthValue& truth : record.truth_values) {
    if (static_cast<std::size_t>(truth.feature) != index) continue;
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ",
                        plain_words(core::Phrase(truth.name)), truth.value);
  }
  if (text.empty()) return {};
  return fmt::format(R"(<div class="truth"><b>{}</b> {}{}</div>)",
                     tr("Hidden truth of the simulation:"), text,
                     tr(". This is not part of the measurement: evaluation never reads it."));
}

std::string body_of(const evaluation::AnalysisResult& result, const record::RunRecord& record,
                    int feature) {
  struct Writer {
    const record::RunRecord& record;
    int feature;
    std::string operator()(const evaluation::SpindleResult& found) const {
      return spindle_part(found, record, feature);
    }
    std::string operator()(const evaluation::WheelResult& found) const { return wheel_part(found); }
    std::string operator()(const evaluation::ContourResult& found) const {
      return contour_part(found, record, feature);
    }
    std::string operator()(const evaluation::RotaryResult& found) const {
      return rotary_part(found, record, feature);
    }
  };
  return std::visit(Writer{record, feature}, result.found);
}

}  // namespace

std::string analysis_section(const record::RunRecord& record, std::size_t index,
                             const evaluation::FeatureResult& feature) {
  const record::Feature& asked = feature.feature;
  std::string html = fmt::format(
      R"(<section><h2>{}</h2><p class="note">{}</p>)", trf("Feature {}", isolated(asked.id)),
      trf("{}.", asked.shape == record::Shape::kRotaryAxes
                     ? tr("Calibration of the fixture with balls that it carried")
                     : trf("{}; data {}", capitalised(tr(record::name_of(asked.shape))),
                           asked.points_file.empty()
                               ? tr("simulated")
                               : trf("from the file {}", isolated(asked.points_file)))));
  html += messages(feature);
  if (feature.analysis) html += body_of(*feature.analysis, record, static_cast<int>(index));
  return html + truth_box(record, index) + "</section>";
}

}  // namespace rondure::reports
