#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/contour/result.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using record::Form;

double number(const record::Feature& feature, std::string_view name, double otherwise) {
  return feature.number(name).value_or(otherwise);
}

/// Turns the settings of the journal into options of the study.
fit::ContourStudyOptions contour_options(const record::Feature& feature) {
  fit::ContourStudyOptions out;
  const auto is = [&](std::string_view key, std::string_view word) {
    return feature.word(key) == word;
  };
  out.geometry = {number(feature, "crank_radius_mm", out.geometry.crank_radius_mm),
                  number(feature, "wheel_radius_mm", out.geometry.wheel_radius_mm),
                  number(feature, "pin_radius_mm", out.geometry.pin_radius_mm)};
  out.main_radius_mm = number(feature, "main_radius_mm", out.main_radius_mm);
  if (is("method", "as-published")) out.method = fit::ContourMethod::kAsPublished;
  if (is("error", "command-minus-actual")) out.axes.error_sign = -1;
  if (is("c_axis", "against-wheel")) out.axes.c_direction = -1;
  if (is("gauge", "clockwise")) out.gauge_direction = -1;
  out.axes.samples = static_cast<std::size_t>(number(feature, "path_samples", 1440.0));
  out.samples = static_cast<std::size_t>(number(feature, "samples", 1440.0));
  out.phase_offset_rad = number(feature, "phase_offset_deg", 0.0) * kDegree;
  out.main_phase_offset_rad = number(feature, "main_phase_offset_deg", 0.0) * kDegree;
  out.pre_filter_upr = number(feature, "pre_filter_upr", 0.0);
  out.error.filter.cutoff_upr = number(feature, "cutoff_upr", out.error.filter.cutoff_upr);
  if (is("filter", "none")) out.error.filter.filter = fit::ProfileFilter::kNone;
  out.prefiltered = is("filter", "done-by-gauge");
  if (is("base_circle", "geometric")) out.error.base = fit::BaseCircle::kGeometric;
  out.map_main = is("main_journal", "mapped");
  out.limits = {number(feature, "stable_from", out.limits.stable),
                number(feature, "partly_from", out.limits.partly)};
  return out;
}

std::vector<double> scaled(const record::Series& series, std::string_view column, double unit) {
  std::vector<double> values = series.column(column).value_or(std::vector<double>());
  for (double& value : values) value *= unit;
  return values;
}

fit::GaugeRows gauge_of(const record::Series& series) {
  return {scaled(series, "angle_deg", kDegree), scaled(series, "deviation_um", kMicrometre)};
}

/// The parts of a record, in order; one for each axis trace.
std::vector<fit::ContourPart> parts_of(const record::RunRecord& record, int index) {
  std::vector<fit::ContourPart> out;
  for (int i = 1;; ++i) {
    const auto* const axes = record.data_of(index, fmt::format("axes {}", i));
    const auto* const pin = record.data_of(index, fmt::format("pin {}", i));
    if (axes == nullptr || pin == nullptr) return out;
    fit::ContourPart part;
    part.trace = {scaled(*axes, "c_deg", kDegree), scaled(*axes, "c_error_deg", kDegree),
                  scaled(*axes, "x_error_mm", 1.0), scaled(*axes, "d_cmd_mm", 1.0)};
    part.pin = gauge_of(*pin);
    const auto* const main = record.data_of(index, fmt::format("main {}", i));
    if (main != nullptr) part.main = gauge_of(*main);
    out.push_back(std::move(part));
  }
}

/// The names of the parts in the plan, or their numbers where the plan gives none.
std::vector<std::string> names_of(const record::Feature& feature, std::size_t parts) {
  std::vector<std::string> out;
  for (const record::Setting& setting : feature.settings) {
    if (setting.name == "parts/name") out.push_back(setting.text);
  }
  out.resize(parts);
  for (std::size_t i = 0; i < parts; ++i) {
    if (out[i].empty()) out[i] = std::to_string(i + 1);
  }
  return out;
}

/// Greatest peak to valley of t over all parts.
core::Result<AnalysisValue> deviation_value(const ContourResult& facts) {
  AnalysisValue out;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const double range = facts.study.parts[i].pin.contour.peak_to_valley_mm;
    if (i > 0 && range <= out.value_mm) continue;
    out.value_mm = range;
    out.detail = fmt::format("part {}", facts.names[i]);
  }
  return out;
}

core::Result<AnalysisValue> spread_value(const ContourResult& facts) {
  if (!facts.study.total) {
    return core::fail(Code::kTooFewPoints, "one part shows no spread; at least 2 are needed");
  }
  AnalysisValue out;
  out.value_mm = facts.study.total->spread;
  out.detail = fmt::format("stability index {:.4f}", facts.study.total->index.value_or(0.0));
  return out;
}

/// The harmonic of any part that is nearest to its limit, or farthest beyond it.
core::Result<AnalysisValue> mask_value(const ContourResult& facts,
                                       const record::Characteristic& asked) {
  AnalysisValue out;
  double worst = -1.0;
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const auto& curve = facts.study.parts[i].pin.contour.error_mm;
    for (const record::HarmonicLimit& line : asked.harmonic_limits) {
      for (const fit::Harmonic& h : fit::contour_harmonics(curve, line.last)) {
        const double share = h.amplitude_mm / line.amplitude_mm;
        if (h.number < line.first || share <= worst) continue;
        worst = share;
        out.value_mm = h.amplitude_mm;
        out.limit_mm = line.amplitude_mm;
        out.detail =
            fmt::format("harmonic {} of part {} is nearest to its limit", h.number, facts.names[i]);
      }
    }
  }
  if (worst < 0.0) return core::fail(Code::kMeaning, "the mask names no harmonic of the contours");
  return out;
}

}  // namespace

core::Result<AnalysisValue> value_of(const ContourResult& facts,
                                     const record::Characteristic& asked) {
  switch (asked.form) {
    case Form::kContourDeviation:
      return deviation_value(facts);
    case Form::kContourSpread:
      return spread_value(facts);
    case Form::kHarmonicLimits:
      return mask_value(facts, asked);
    default:
      return core::fail(Code::kMeaning, fmt::format("a contour has no {}", name_of(asked.form)));
  }
}

std::string filter_text(const ContourResult& facts) {
  const fit::FilterOptions& filter = facts.options.error.filter;
  if (filter.filter == fit::ProfileFilter::kNone) return "unfiltered";
  return facts.options.prefiltered
             ? fmt::format("gaussian low pass {:g} UPR by the gauge", filter.cutoff_upr)
             : fmt::format("gaussian low pass {:g} UPR", filter.cutoff_upr);
}

std::string sampling_text(const ContourResult& facts) {
  const std::size_t parts = facts.study.parts.size();
  return fmt::format("{} {} of {} points", parts, parts == 1 ? "part" : "parts",
                     facts.options.samples);
}

ValueOperator operator_of(const ContourResult& facts, const record::Characteristic& asked,
                          const std::string& temperature) {
  const std::string what = asked.form == Form::kContourSpread
                               ? "standard deviation of the parts about their mean contour"
                           : asked.form == Form::kHarmonicLimits
                               ? "amplitudes of the filtered contours"
                               : "peak to valley, greatest of all parts";
  const char* base =
      facts.options.error.base == fit::BaseCircle::kLimacon ? "limacon" : "geometric";
  return {ReferenceTerm(fmt::format("{}; base circle {}", what, base)),
          FilterTerm(filter_text(facts)), SamplingTerm(sampling_text(facts)),
          TipTerm("readings as given"), TemperatureTerm(temperature)};
}

core::Result<ContourResult> evaluate_contour(const record::RunRecord& record, int index,
                                             FeatureResult& result) {
  ContourResult facts;
  facts.options = contour_options(result.feature);
  const auto parts = parts_of(record, index);
  auto study = fit::contour_study(parts, facts.options);
  if (!study) return tl::unexpected(study.error());
  facts.study = *std::move(study);
  facts.names = names_of(result.feature, parts.size());
  result.warnings = facts.study.warnings;
  return facts;
}

}  // namespace rondure::evaluation
