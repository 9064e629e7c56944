#include "plans/analyses/analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/internal/feature_references.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/schema/json_text.h"
#include "record/sha256.h"

namespace rondure::plans {
namespace {

using core::Code;

std::array<const AnalysisKind*, 5> kinds() {
  return {&spindle_kind(), &wheel_kind(), &contour_kind(), &rotary_kind(), &five_axis_kind()};
}

core::Result<AnalysisData> read_files(const Plan& plan, std::size_t index,
                                      const AnalysisKind& kind) {
  AnalysisData out;
  std::string digests;
  for (const SeriesFile& file : kind.files(plan.features[index])) {
    std::error_code unknown;
    if (follows_loading(plan.features[index]) &&
        !std::filesystem::exists(plan.folder / file.file, unknown)) {
      return AnalysisData{};
    }
    const auto bytes = read_data_file(plan.folder / file.file, file.file);
    if (!bytes) return core::fail(bytes.error().at(feature_pointer(index) + file.where));
    TRY(auto series, file.read
                         ? file.read(*bytes, file.file)
                         : record::parse_series_csv(*bytes, file.file, file.wanted, file.names));
    series.feature = static_cast<int>(index);
    series.name = file.series;
    out.series.push_back(std::move(series));
    out.sha256 = record::sha256_hex(*bytes);
    digests += fmt::format("{} {}\n", out.sha256, file.file);
  }
  if (out.series.size() > 1) out.sha256 = record::sha256_hex(digests);
  return out;
}

/// Adds the column that a sensor beside the part would write.
void add_temperature(double degC, record::Series& series) {
  const std::size_t width = series.columns.size();
  const std::size_t rows = series.rows();
  std::vector<double> values;
  values.reserve(rows * (width + 1));
  for (std::size_t row = 0; row < rows; ++row) {
    const auto first = series.values.begin() + static_cast<std::ptrdiff_t>(row * width);
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(width));
    values.push_back(degC);
  }
  series.columns.push_back({std::string(record::kTemperatureColumn), "degC"});
  series.values = std::move(values);
}

/// "roundness, run-out".
std::string list_of(std::span<const record::Form> forms) {
  std::string out;
  for (const record::Form form : forms) {
    if (!out.empty()) out += ", ";
    out += name_of(form);
  }
  return out;
}

void check_forms(const FeaturePlan& feature, const AnalysisKind& kind, const std::string& where,
                 Findings& findings) {
  for (std::size_t k = 0; k < feature.characteristics.size(); ++k) {
    const std::string place = item_pointer(where + "/characteristics", k) + "/form";
    const record::Form form = feature.characteristics[k].form;
    if (!findings.sound(place) ||
        std::find(kind.forms.begin(), kind.forms.end(), form) != kind.forms.end()) {
      continue;
    }
    findings.meaning(
        Code::kMeaning, place,
        fmt::format("a {} has no {}; ask for {}", kind.type, name_of(form), list_of(kind.forms)));
  }
}

/// Checks that a feature has its own section and no others, and no keys without effect.
void check_sections(const AnalysisKind& kind, const std::string& where, Findings& findings) {
  if (!findings.is_given(fmt::format("{}/{}", where, kind.type))) {
    findings.meaning(Code::kMissingKey, fmt::format("{}/{}", where, kind.type),
                     fmt::format("this key is missing: it says how a {} is evaluated", kind.type));
  }
  for (const std::string_view key :
       {"/nominal", "/sampling", "/pose_search", "/source/tip_diameter_mm", "/source/feature",
        "/source/others", "/source/clamping", "/source/unit", "/source/layers", "/source/mesh",
        "/source/points", "/letter", "/exclude"}) {
    if (!findings.is_given(where + std::string(key))) continue;
    findings.meaning(
        Code::kMeaning, where + std::string(key),
        fmt::format("has no effect: {}; remove it",
                    kind.check_cell != nullptr ? std::string("balls are touched, no surface")
                                               : fmt::format("a {} is not touched", kind.type)));
  }
}

void check_data(const Plan& plan, std::size_t index, const AnalysisKind& kind, Findings& findings) {
  const std::string where = feature_pointer(index);
  if (kind.check_cell != nullptr) return kind.check_cell(plan, index, findings);
  if (has_files(plan.features[index])) {
    if (!findings.sound(where + "/source")) return;
    if (const auto data = read_files(plan, index, kind); !data) {
      findings.meaning(data.error().code, data.error().where.empty() ? where : data.error().where,
                       data.error().what);
    }
    return;
  }
  const std::string simulated = fmt::format("/simulation/{}", kind.type);
  if (plan.simulation && kind.is_simulated(*plan.simulation)) return;
  findings.meaning(Code::kMissingKey, simulated,
                   fmt::format("this key is missing: feature {} has no source; say what is "
                               "simulated, or give the feature a \"source\" file",
                               index + 1));
}

}  // namespace

std::vector<SeriesFile> source_file(const FeaturePlan& feature,
                                    std::span<const record::WantedColumn> wanted) {
  if (!feature.source) return {};
  SeriesFile out;
  out.file = feature.source->file;
  out.where = "/source/file";
  out.wanted.assign(wanted.begin(), wanted.end());
  for (const ColumnPlan& column : feature.source->columns) {
    out.names.push_back({column.column, column.in_file});
  }
  return {out};
}

double sum_of(std::span<const HarmonicPlan> harmonics, double angle_rad) {
  double sum = 0.0;
  for (const HarmonicPlan& h : harmonics) {
    sum += h.amplitude_um * std::cos(h.order * angle_rad - h.phase_deg * core::kDegree);
  }
  return sum;
}

bool has_files(const FeaturePlan& feature) {
  const AnalysisKind* const kind = analysis_kind(feature.type);
  return kind != nullptr && !kind->files(feature).empty();
}

bool follows_loading(const FeaturePlan& feature) {
  return (feature.five_axis && feature.five_axis->repeat && feature.source) ||
         (feature.contour && feature.contour->repeat && !feature.contour->parts.empty());
}

bool measures_by_touch(const FeaturePlan& feature) {
  const AnalysisKind* const kind = analysis_kind(feature.type);
  return kind != nullptr && kind->check_cell != nullptr;
}

const AnalysisKind* analysis_kind(record::Shape shape) {
  for (const AnalysisKind* kind : kinds()) {
    if (kind->shape == shape) return kind;
  }
  return nullptr;
}

core::Result<AnalysisData> analysis_data(const Plan& plan, std::size_t index, std::uint64_t seed) {
  const AnalysisKind& kind = *analysis_kind(plan.features[index].type);
  if (has_files(plan.features[index])) return read_files(plan, index, kind);
  const auto simulate = [&](bool errors) -> core::Result<AnalysisData> {
    TRY(auto out, kind.simulate(plan, index, seed, errors));
    // Only a plan with limits asks for the temperature; the data of others stay as they were.
    for (record::Series& series : out.series) {
      if (plan.environment && series.role == record::Series::Role::kData) {
        add_temperature(plan.simulation->temperature_degC, series);
      }
    }
    return out;
  };
  TRY(auto out, simulate(true));
  TRY(auto truth, simulate(false));
  for (record::Series& series : truth.series) {
    if (series.role != record::Series::Role::kData) continue;
    series.role = record::Series::Role::kTruth;
    out.series.push_back(std::move(series));
  }
  return out;
}

void check_analysis(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const AnalysisKind* kind = analysis_kind(feature.type);
  const std::string where = feature_pointer(index);
  if (kind == nullptr || !findings.sound(where + "/type")) return;
  check_sections(*kind, where, findings);
  check_forms(feature, *kind, where, findings);
  const std::string section = fmt::format("{}/{}", where, kind->type);
  if (findings.is_given(section) && findings.sound(section)) {
    kind->check(feature, section, findings);
  }
  check_references(plan, index, findings);
  check_data(plan, index, *kind, findings);
}

}  // namespace rondure::plans
