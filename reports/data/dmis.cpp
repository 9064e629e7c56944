#include "reports/data/dmis.h"

#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/utf8.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/section.h"
#include "reports/words/internal/facts.h"

namespace rondure::reports {
namespace {

using core::decimal;
using core::printable;

using record::Form;

/// Text of the record for a comment. DMIS is ASCII, and a `$` may continue a line: other bytes and
/// `$` become "?".
std::string remark(std::string_view text) {
  constexpr std::size_t kLongest = 200;  // bytes of a name; longer texts are cut
  std::string out;
  for (const char c : printable(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // rest of a character with a mark
    out += byte >= 0x20 && byte < 0x7F && c != '$' ? c : '?';
  }
  return out.size() <= kLongest ? out : out.substr(0, kLongest - 3) + "...";
}

std::string comment(std::string_view what, std::string_view text) {
  return fmt::format("$$ {}: {}\n", what, remark(text));
}

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("{},{},{}", decimal(v.x()), decimal(v.y()), decimal(v.z()));
}

/// "CYLNDR,OUTER,CART,x,y,z,i,j,k,diameter[,length]" or the same of a circle: least squares.
std::optional<std::string> actual_feature(const evaluation::FeatureResult& feature) {
  const auto ls = least_squares_of(feature);
  if (!ls) return {};
  const char* side = feature.feature.side == record::Side::kOutside ? "OUTER" : "INNER";
  if (feature.ls_cylinder) {
    const fit::Axis& axis = feature.ls_cylinder->axis;
    const auto [low_mm, high_mm] = heights_of(feature);
    return fmt::format("CYLNDR,{},CART,{},{},{},{}", side, vector_text(axis.point_mm),
                       vector_text(axis.direction), decimal(2.0 * ls->radius_mm),
                       decimal(high_mm - low_mm));
  }
  const evaluation::LayerResult& section = feature.layers.front();
  const fit::Axis axis = section_axis(feature, section, section.ls->center_mm);
  return fmt::format("CIRCLE,{},CART,{},{},{}", side, vector_text(axis.point_mm),
                     vector_text(axis.direction), decimal(2.0 * ls->radius_mm));
}

/// The DMIS word for the tolerance of a characteristic, where there is one.
const char* tolerance_word(const record::Characteristic& asked) {
  if (asked.form == Form::kCylindricity) return "CYLCTY";
  return asked.form == Form::kRoundness ? "CIRLTY" : nullptr;
}

/// The block of one characteristic: its tolerance, and its result or the reason why there is none.
std::string characteristic_block(const evaluation::CharacteristicResult& result,
                                 const std::string& feature, const std::string& label) {
  const record::Characteristic& asked = result.characteristic;
  std::string text =
      comment(label, fmt::format("{}; {} {}; {}", asked.id, evaluation::symbol_of(asked),
                                 evaluation::reference_of(asked), name_of(result.verdict)));
  const char* word = tolerance_word(asked);
  const bool decided = result.verdict == evaluation::Verdict::kConforms ||
                       result.verdict == evaluation::Verdict::kDoesNotConform;
  if (word == nullptr || !decided || !result.value || !asked.tolerance_mm) {
    if (result.value) text += comment(label, result.value->sentence().english());
    return text + comment(label, "no block in DMIS; " + result.reason.english());
  }
  text += comment(label, result.value->sentence().english());
  text += fmt::format("T({})=TOL/{},{}\n", label, word, decimal(*asked.tolerance_mm));
  text += fmt::format("OUTPUT/FA({}),TA({})\n", feature, label);
  text += fmt::format("TA({})=TOL/{},{},{}\n", label, word, decimal(result.value->quoted_mm()),
                      result.verdict == evaluation::Verdict::kConforms ? "INTOL" : "OUTOL");
  return text;
}

std::string feature_block(const evaluation::FeatureResult& feature, std::size_t number) {
  const std::string label = fmt::format("F{}", number);
  std::string text = comment(
      label, fmt::format("{}, {}", feature.feature.id, record::name_of(feature.feature.shape)));
  if (feature.failure) text += comment(label, "no result; " + feature.failure->what);
  const auto actual =
      record::is_analysis(feature.feature.shape) ? std::nullopt : actual_feature(feature);
  if (actual) {
    text += comment(label, feature.merged ? "least squares; body frame, of several poses"
                                          : "least squares; machine frame, final pose");
    text += fmt::format("FA({})=FEAT/{}\n", label, *actual);
  }
  for (std::size_t i = 0; i < feature.characteristics.size(); ++i) {
    const evaluation::CharacteristicResult& result = feature.characteristics[i];
    const std::string tolerance = fmt::format("{}T{}", label, i + 1);
    if (actual) {
      text += characteristic_block(result, label, tolerance);
      continue;
    }
    text += comment(tolerance, fmt::format("{}; {}; {}; {}", result.characteristic.id,
                                           evaluation::symbol_of(result.characteristic),
                                           name_of(result.verdict), result.reason.english()));
  }
  return text;
}

}  // namespace

std::string write_dmis(const record::RunRecord& record, const evaluation::Evaluation& evaluation) {
  const record::Header& header = record.header;
  std::string text = "FILNAM/'OUTPUT',05.2\n";
  text +=
      "$$ Output block, written by rondure; no measuring program. It carries neither uncertainty\n"
      "$$ nor decision rule nor points: report.qif and report.json do.\n";
  text += comment("program", "rondure " + header.version);
  text += comment("run", header.run_id);
  text += comment("started", header.started_utc);
  text += comment("plan", header.plan_name + ", revision " + header.plan_revision);
  text += comment("part", header.part_id + ", " + header.part_name);
  text += comment("drawing", header.drawing);
  text += comment("serial", header.serial);
  text += comment("operator", header.operator_name);
  if (header.simulated) text += comment("simulated", "no real part was measured");
  text += comment("decision rule", rule_in_words(header));
  text += comment("verdict", name_of(evaluation.verdict));
  if (record.ending != "finished") {
    text +=
        comment("not finished", record.failure ? core::to_line(*record.failure) : record.ending);
  }
  text += "UNITS/MM,ANGDEC\n";
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    text += feature_block(evaluation.features[i], i + 1);
  }
  return text + "ENDFIL\n";
}

}  // namespace rondure::reports
