#include "reports/data/writers.h"

#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/section.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

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

/// "CYLNDR,OUTER,CART,x,y,z,i,j,k,diameter[,length]", the same of a circle,
/// "PLANE,CART,x,y,z,i,j,k": least squares.
std::optional<std::string> actual_feature(const evaluation::FeatureResult& feature) {
  if (const auto& ls_plane = feature.ls_plane) {
    return fmt::format("PLANE,CART,{},{}", vector_text(ls_plane->plane.point_mm),
                       vector_text(ls_plane->plane.normal));
  }
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
  if (asked.indication.parameter != record::Indication::Parameter::kTotal) return nullptr;
  switch (asked.form) {
    case Form::kCylindricity:
      return "CYLCTY";
    case Form::kRoundness:
      return "CIRLTY";
    case Form::kDiameter:
      return evaluation::unit_of(asked) == core::ValueUnit::kMm ? "DIAM" : nullptr;
    case Form::kStraightness:
      return "STRGHT";
    case Form::kFlatness:
      return "FLAT";
    case Form::kCoaxiality:
    case Form::kConcentricity:
      return "CONCEN";
    case Form::kParallelism:
      return "PARLEL";
    case Form::kPerpendicularity:
      return "PERP";
    case Form::kAngularity:
      return "ANGLR";
    case Form::kRunOut:
      return asked.indication.datum.empty() ? nullptr : "CRNOUT";
    case Form::kTotalRunOut:
      return "TRNOUT";
    default:
      return nullptr;
  }
}

/// ",DAT(DF1-DF2)" of each datum; the features F1, F2 are its datum features.
std::string datum_words(const evaluation::CharacteristicResult& result) {
  std::string text;
  for (const evaluation::DatumResult& datum : result.finding->datums) {
    std::string name;
    for (const std::size_t feature : datum.features) {
      name += fmt::format("{}DF{}", name.empty() ? "" : "-", feature + 1);
    }
    text += fmt::format(",DAT({})", name);
  }
  return text;
}

/// A characteristic as a tolerance of DMIS.
struct ToleranceBlock {
  std::string asked;   ///< After TOL/ of the nominal.
  std::string actual;  ///< After TOL/ of the actual, without its verdict.
  std::string datums;  ///< After both.
};

/// The block, or why DMIS has none.
core::Result<ToleranceBlock> tolerance_block(const evaluation::CharacteristicResult& result,
                                             double nominal_diameter_mm) {
  const record::Characteristic& asked = result.characteristic;
  const auto none = [](std::string_view why) {
    return core::fail(core::Code::kMeaning, std::string(why));
  };
  const char* word = tolerance_word(asked);
  const bool decided = result.verdict == evaluation::Verdict::kConforms ||
                       result.verdict == evaluation::Verdict::kDoesNotConform;
  if (word == nullptr || !decided || !result.value || !asked.toleranced()) return none("");
  ToleranceBlock block;
  block.actual = fmt::format("{},{}", word, decimal(result.value->quoted_mm()));
  if (evaluation::unit_of(asked) == core::ValueUnit::kMm) {
    if (!asked.lower_mm || !asked.tolerance_mm) return none("TOL/DIAM needs both limits; ");
    if (result.finding && result.finding->judged.size() > 1)
      return none("two values are judged, and TOL/DIAM holds one; ");
    const auto deviation = [&](double limit_mm) {
      constexpr double kSteps = 1e9;
      return decimal(core::on_grid(limit_mm - nominal_diameter_mm, kSteps));
    };
    block.asked =
        fmt::format("{},{},{}", word, deviation(*asked.lower_mm), deviation(*asked.tolerance_mm));
    return block;
  }
  if (asked.lower_mm || !asked.tolerance_mm) return none("a tolerance of DMIS has one limit; ");
  block.asked = fmt::format("{},{}", word, decimal(*asked.tolerance_mm));
  if (asked.indication.datum.empty()) return block;
  if (!result.finding || result.finding->datums.empty()) return none("no datum was found; ");
  const bool orientation = asked.form == Form::kParallelism ||
                           asked.form == Form::kPerpendicularity || asked.form == Form::kAngularity;
  block.datums = (orientation ? ",RFS" : "") + datum_words(result);
  return block;
}

/// Empty where the rule of the run holds.
std::string own_rule_remark(const std::string& label, const record::Characteristic& asked) {
  const std::string own = own_rule_in_words(asked);
  return own.empty() ? own : comment(label, "decision rule of this line: " + own);
}

/// Why a value of an analysis has no interval; empty with one.
std::string no_interval_remark(const std::string& label,
                               const evaluation::CharacteristicResult& result) {
  if (!result.value || result.value->uncertainty().result()) return {};
  const core::Phrase& why = result.value->uncertainty().why();
  return why.empty() ? std::string() : comment(label, "no interval: " + why.english());
}

/// The block of one characteristic: its tolerance, and its result or the reason why there is none.
std::string characteristic_block(const evaluation::CharacteristicResult& result,
                                 double nominal_diameter_mm, const std::string& feature,
                                 const std::string& label) {
  const record::Characteristic& asked = result.characteristic;
  std::string text =
      comment(label, fmt::format("{}; {} {}; {}", asked.id, evaluation::symbol_of(asked),
                                 evaluation::reference_of(asked), name_of(result.verdict)));
  text += own_rule_remark(label, asked);
  const auto block = tolerance_block(result, nominal_diameter_mm);
  if (!block) {
    if (result.value) text += comment(label, result.value->sentence().english());
    return text +
           comment(label, "no block in DMIS; " + block.error().what + result.reason.english());
  }
  text += comment(label, result.value->sentence().english());
  text += fmt::format("T({})=TOL/{}{}\n", label, block->asked, block->datums);
  text += fmt::format("OUTPUT/FA({}),TA({})\n", feature, label);
  text += fmt::format("TA({})=TOL/{},{}{}\n", label, block->actual,
                      result.verdict == evaluation::Verdict::kConforms ? "INTOL" : "OUTOL",
                      block->datums);
  return text;
}

/// DATDEF of every feature that is a datum; after all features, before what refers to them.
std::string datum_definitions(const evaluation::Evaluation& evaluation) {
  std::set<std::size_t> datums;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      if (!result.finding) continue;
      for (const evaluation::DatumResult& datum : result.finding->datums)
        datums.insert(datum.features.begin(), datum.features.end());
    }
  }
  std::string text;
  for (const std::size_t datum : datums)
    text += fmt::format("DATDEF/FA(F{0}),DAT(DF{0})\n", datum + 1);
  return text;
}

/// "gate first-harmonic, passed: chi2 of the first harmonic; found 3.2, limit 7.5".
std::string gate_remark(const evaluation::Gate& gate) {
  std::string text = fmt::format(
      "gate {}, {}: {}; found {}, limit {}", gate.code, name_of(gate.outcome),
      gate.condition.english(), number_of(gate.found, gate.unit), number_of(gate.limit, gate.unit));
  if (!gate.reason.empty()) text += "; " + gate.reason.english();
  return text;
}

/// Appends what needs no datum to `text`, what needs one to `about_datums`.
void add_feature(const evaluation::FeatureResult& feature, std::size_t number, std::string& text,
                 std::string& about_datums) {
  const std::string label = fmt::format("F{}", number);
  text += comment(
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
      std::string& to = result.characteristic.indication.datum.empty() ? text : about_datums;
      to += characteristic_block(result, feature.feature.nominal_diameter_mm, label, tolerance);
      continue;
    }
    text += comment(tolerance, fmt::format("{}; {}; {}; {}", result.characteristic.id,
                                           evaluation::symbol_of(result.characteristic),
                                           name_of(result.verdict), result.reason.english()));
    text += own_rule_remark(tolerance, result.characteristic);
    if (result.value) text += comment(tolerance, result.value->sentence().english());
    if (record::is_analysis(feature.feature.shape)) text += no_interval_remark(tolerance, result);
  }
  for (const evaluation::Gate& gate : feature.gates) text += comment(label, gate_remark(gate));
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
  std::string about_datums;
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    add_feature(evaluation.features[i], i + 1, text, about_datums);
  }
  return text + datum_definitions(evaluation) + about_datums + "ENDFIL\n";
}

}  // namespace rondure::reports
