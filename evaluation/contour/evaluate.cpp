#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/contour/internal/gates.h"
#include "evaluation/contour/internal/trials.h"
#include "evaluation/contour/result.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/chain.h"
#include "evaluation/results/evaluation.h"
#include "record/tasks/contour.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using record::ContourTask;
using record::Form;

std::vector<double> scaled(const record::Series& series, std::string_view column, double unit) {
  std::vector<double> values = series.column(column).value_or(std::vector<double>());
  for (double& value : values) value *= unit;
  return values;
}

/// The parts of a record, in order. An indirect separation takes no traces.
std::vector<fit::ContourPart> parts_of(const record::RunRecord& record, int index,
                                       ContourTask::Separation separation) {
  std::vector<fit::ContourPart> out;
  for (int i = 1;; ++i) {
    const auto* const axes = record.data_of(index, fmt::format("axes {}", i));
    const auto* const pin = record.data_of(index, fmt::format("pin {}", i));
    if (pin == nullptr) return out;
    fit::ContourPart part;
    if (axes != nullptr && separation != ContourTask::Separation::kIndirect) {
      part.trace = trace_of(*axes);
    }
    part.pin = rows_of(*pin);
    const auto* const main = record.data_of(index, fmt::format("main {}", i));
    if (main != nullptr) part.main = rows_of(*main);
    out.push_back(std::move(part));
  }
}

/// The names of the parts in the plan; their numbers where it gives none.
std::vector<std::string> names_of(const ContourTask& task, std::size_t parts) {
  std::vector<std::string> out;
  for (const record::ContourPartTask& part : task.parts) out.push_back(part.name);
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
    out.detail = core::phrase("part {}", facts.names[i]);
  }
  return out;
}

/// Why the spread is no spread of parts: the readings of one were given for another.
std::optional<core::Phrase> same_readings(const ContourResult& facts) {
  const auto& parts = facts.study.parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (parts[i].pin.contour.error_mm != parts[j].pin.contour.error_mm) continue;
      return core::phrase(
          "parts {} and {} have the same contour to the last digit: give each its "
          "own readings",
          facts.names[j], facts.names[i]);
    }
  }
  return std::nullopt;
}

core::Result<AnalysisValue> spread_value(const ContourResult& facts) {
  if (!facts.study.total) {
    return core::fail(Code::kTooFewPoints, "one part shows no spread; at least 2 are needed");
  }
  AnalysisValue out;
  out.value_mm = facts.study.total->spread;
  out.void_because = same_readings(facts);
  out.detail = core::phrase("stability index {:.4f}", facts.study.total->index.value_or(0.0));
  return out;
}

/// The highest undulation that the filtered contours still hold by half: beyond the cut-off their
/// amplitudes are those of the filter.
int highest_judged(const ContourResult& facts) {
  const auto of_points = static_cast<int>((facts.options.samples - 1) / 2);
  const fit::FilterOptions& filter = facts.options.error.filter;
  if (filter.filter == fit::ProfileFilter::kNone) return of_points;
  return static_cast<int>(std::min<double>(of_points, std::floor(filter.cutoff_upr)));
}

core::Result<AnalysisValue> following_value(const ContourResult& facts) {
  AnalysisValue out;
  out.value_mm = fit::peak_to_valley(fit::mean_following(facts.study));
  const std::size_t parts = facts.study.parts.size();
  const core::Phrase of =
      parts == 1 ? core::phrase("{} part", parts) : core::phrase("mean of {} parts", parts);
  const bool supposed = !facts.study.traced() && facts.indirect_is_bound;
  out.detail =
      supposed ? core::phrase("{}, if pin and main journal see the same", of) : core::Phrase(of);
  return out;
}

/// The harmonic of any part that is nearest to its limit, or farthest beyond it.
core::Result<AnalysisValue> mask_value(const ContourResult& facts,
                                       const record::Characteristic& asked) {
  AnalysisValue out;
  double worst = -1.0;
  const int highest = highest_judged(facts);
  for (std::size_t i = 0; i < facts.study.parts.size(); ++i) {
    const auto& curve = facts.study.parts[i].pin.contour.error_mm;
    for (const record::HarmonicLimit& line : asked.harmonic_limits) {
      for (const fit::Harmonic& h : fit::contour_harmonics(curve, line.last)) {
        const double share = h.amplitude_mm / line.amplitude_mm;
        if (h.number < line.first || share <= worst) continue;
        worst = share;
        out.value_mm = h.amplitude_mm;
        out.limit_mm = line.amplitude_mm;
        out.harmonic = h.number;
        out.part = i;
        out.detail = core::phrase("harmonic {} of part {} is nearest to its limit", h.number,
                                  facts.names[i]);
      }
    }
  }
  if (worst < 0.0) return core::fail(Code::kMeaning, "the mask names no harmonic of the contours");
  for (const record::HarmonicLimit& line : asked.harmonic_limits) {
    if (line.last <= highest) continue;
    out.void_because = core::phrase(
        "the mask reaches to harmonic {}, {} is the highest that the filter and the points leave",
        line.last, highest);
    // What is left of an amplitude above its limit is above it all the more before the filter.
    out.lower_bound = true;
  }
  return out;
}

core::Result<AnalysisValue> measured_value(const ContourResult& facts,
                                           const record::Characteristic& asked) {
  switch (asked.form) {
    case Form::kContourDeviation:
      return deviation_value(facts);
    case Form::kContourSpread:
      return spread_value(facts);
    case Form::kHarmonicLimits:
      return mask_value(facts, asked);
    case Form::kFollowingDeviation:
      return following_value(facts);
    default:
      return core::fail_with(Code::kMeaning, "a contour has no {}", name_of(asked.form));
  }
}

/// The words of a curve: "stable" needs the lower end of the interval of the index. Without an
/// interval there is none, and of a void curve there is no word at all.
void word_from_interval(std::optional<fit::Repeatability>& curve, ContourNumber::Curve which,
                        const std::vector<ContourNumber>& numbers, bool voided) {
  if (!curve) return;
  curve->no_word = voided;
  for (const ContourNumber& number : numbers) {
    if (number.curve != which || number.kind != ContourNumber::Kind::kIndex) continue;
    const auto& stated = number.uncertainty.result();
    if (stated) curve->index_low = stated->sampled.low_mm;
  }
  if (!curve->index_low && curve->index.value_or(0.0) >= fit::kStableFrom) curve->no_word = true;
}

void keep_words(ContourResult& facts) {
  using Curve = ContourNumber::Curve;
  const auto keep = [&](std::optional<fit::Repeatability>& curve, Curve which, bool voided) {
    word_from_interval(curve, which, facts.numbers, voided);
  };
  keep(facts.study.total, Curve::kTotal, facts.total_void.has_value());
  keep(facts.study.following, Curve::kFollowing, facts.following_void.has_value());
  keep(facts.study.rest, Curve::kRest, facts.rest_void.has_value());
  keep(facts.study.main, Curve::kMain, false);
}

/// Pins whose traces were not recorded: none of them, or all.
core::Result<void> check_traces(const std::vector<fit::ContourPart>& parts,
                                ContourTask::Separation separation, FeatureResult& result) {
  const auto traced = [](const fit::ContourPart& part) { return part.trace.has_value(); };
  const bool needed =
      separation == ContourTask::Separation::kDirect || std::ranges::any_of(parts, traced);
  const auto without = std::ranges::find_if_not(parts, traced);
  if (!needed || without == parts.end()) return {};
  const core::Phrase reason = core::phrase(
      "part {} has no traces of the axes: its f and n are not known", without - parts.begin() + 1);
  result.gates.push_back({"traces",
                          core::phrase("traces of whole turns without a missing sample"),
                          {},
                          {},
                          "",
                          Gate::Outcome::kVoids,
                          reason});
  return core::fail(Code::kNoPoints, reason);
}

/// The axes moved as their traces show and as the loaded table made them: that is what f follows.
core::Result<void> add_table(const record::RunRecord& record, int index,
                             const fit::ContourStudyOptions& options,
                             std::vector<fit::ContourPart>& parts) {
  constexpr double kAt_deg = 1e-6;
  constexpr std::size_t kLeastRows = 3;
  const record::Series* const series = record.data_of(index, "table");
  if (series == nullptr) {
    return core::fail(Code::kNoPoints, "the correction that was loaded is not in the record");
  }
  if (series->rows() < kLeastRows) {
    return core::fail_with(Code::kTooFewPoints,
                           "the loaded correction has {} rows, {} are needed at least",
                           series->rows(), kLeastRows);
  }
  const auto c_deg = series->column("c_deg").value_or(std::vector<double>());
  const auto x_mm = scaled(*series, "x_um", kMicrometre);
  const auto rows = static_cast<double>(c_deg.size());
  for (std::size_t i = 0; i < c_deg.size(); ++i) {
    const double expected_deg = 360.0 * static_cast<double>(i) / rows;
    if (std::abs(c_deg[i] - expected_deg) <= kAt_deg) continue;
    return core::fail_with(Code::kMeaning,
                           "row {} of the loaded correction stands at C = {} deg, {:.6g} expected: "
                           "equal steps of a whole turn from 0",
                           i + 1, c_deg[i], expected_deg);
  }
  for (fit::ContourPart& part : parts) {
    for (std::size_t i = 0; part.trace && i < part.trace->x_error_mm.size(); ++i) {
      part.trace->x_error_mm[i] +=
          options.axes.error_sign * fit::closed_at(x_mm, part.trace->c_rad[i]);
    }
  }
  return {};
}

}  // namespace

fit::AxisTrace trace_of(const record::Series& series) {
  return {scaled(series, "c_deg", kDegree), scaled(series, "c_error_deg", kDegree),
          scaled(series, "x_error_mm", 1.0), scaled(series, "d_cmd_mm", 1.0)};
}

fit::GaugeRows rows_of(const record::Series& series) {
  return {scaled(series, "angle_deg", kDegree), scaled(series, "deviation_um", kMicrometre)};
}

fit::ContourStudyOptions contour_options(const ContourTask& task) {
  fit::ContourStudyOptions out;
  out.geometry = {task.crank_radius_mm, task.wheel_radius_mm, task.pin_radius_mm};
  out.main_radius_mm = task.main_radius_mm;
  out.method = task.method == ContourTask::Method::kAsPublished ? fit::ContourMethod::kAsPublished
                                                                : fit::ContourMethod::kCorrected;
  out.axes.error_sign = task.error == ContourTask::Error::kCommandMinusActual ? -1 : 1;
  out.axes.c_direction = task.c_axis == ContourTask::CAxis::kAgainstWheel ? -1 : 1;
  out.gauge_direction = task.gauge == ContourTask::Gauge::kClockwise ? -1 : 1;
  out.samples = static_cast<std::size_t>(task.samples);
  out.phase_offset_rad = task.phase_offset_deg * kDegree;
  out.main_phase_offset_rad = task.main_phase_offset_deg * kDegree;
  out.error.filter.cutoff_upr = task.cutoff_upr;
  if (task.filter == ContourTask::Filter::kNone) {
    out.error.filter.filter = fit::ProfileFilter::kNone;
  }
  out.prefiltered = task.filter == ContourTask::Filter::kDoneByGauge;
  out.error.base = task.base_circle == ContourTask::BaseCircle::kGeometric
                       ? fit::BaseCircle::kGeometric
                       : fit::BaseCircle::kLimacon;
  return out;
}

core::Result<AnalysisValue> value_of(const ContourResult& facts,
                                     const record::Characteristic& asked) {
  auto out = measured_value(facts, asked);
  const auto& voided =
      asked.form == Form::kFollowingDeviation ? facts.following_void : facts.total_void;
  if (out && voided) {
    out->void_because = voided;
    out->lower_bound = false;
  }
  return out;
}

core::Phrase filter_text(const ContourResult& facts) {
  const fit::FilterOptions& filter = facts.options.error.filter;
  if (filter.filter == fit::ProfileFilter::kNone) {
    return core::phrase("unfiltered");
  }
  return facts.options.prefiltered
             ? core::phrase("gaussian low pass {:g} UPR by the gauge", filter.cutoff_upr)
             : core::phrase("gaussian low pass {:g} UPR", filter.cutoff_upr);
}

core::Phrase sampling_text(const ContourResult& facts) {
  const std::size_t parts = facts.study.parts.size();
  const core::Phrase number =
      parts == 1 ? core::phrase("{} part", parts) : core::phrase("{} parts", parts);
  return facts.study.traced()
             ? core::phrase("{} of {} points", number, facts.options.samples)
             : core::phrase("{} of {} points, without traces: f by the main journals", number,
                            facts.options.samples);
}

ValueOperator operator_of(const ContourResult& facts, const record::Characteristic& asked,
                          const core::Phrase& temperature) {
  const core::Phrase what =
      asked.form == Form::kContourSpread
          ? core::phrase("standard deviation of the parts about their mean contour")
      : asked.form == Form::kHarmonicLimits ? core::phrase("amplitudes of the filtered contours")
      : asked.form == Form::kFollowingDeviation
          ? core::phrase("peak to valley of the mean f of all parts")
          : core::phrase("peak to valley, greatest of all parts");
  const core::Phrase base = facts.options.error.base == fit::BaseCircle::kLimacon
                                ? core::phrase("limacon")
                                : core::phrase("geometric");
  return {ReferenceTerm(core::phrase("{}; base circle {}", what, base)),
          FilterTerm(filter_text(facts)), SamplingTerm(sampling_text(facts)),
          TipTerm(core::phrase("readings as given")), TemperatureTerm(temperature)};
}

core::Result<ContourResult> evaluate_contour(const record::RunRecord& record, int index,
                                             const RadiusOf& earlier, const ContourOf& pins,
                                             FeatureResult& result) {
  TRY(const auto task, record::task_of<ContourTask>(result.feature.settings));
  ContourResult facts;
  facts.options = contour_options(task);
  if (task.wheel_radius_from) {
    TRY(auto radius, take_radius(task.wheel_radius_from->feature, earlier, result.gates));
    facts.options.geometry.wheel_radius_mm = radius.radius_mm;
    facts.wheel_radius = std::move(radius);
  }
  facts.feature_id = result.feature.id;
  facts.influences = task.uncertainty;
  facts.sampling_ms = task.sampling_ms.value_or(0.0);
  auto parts = parts_of(record, index, task.separation);
  TRY_DO(check_traces(parts, task.separation, result));
  if (task.repeat) {
    TRY_DO(add_table(record, index, facts.options, parts));
    const std::string& with = task.repeat->with.feature;
    auto before = pins(with);
    result.gates.push_back(
        chain_gate(with, before ? std::nullopt : std::optional(before.error().said())));
    if (before) facts.gain = *std::move(before);
  }
  const auto add = [&](std::vector<Gate> gates) {
    for (Gate& gate : gates) result.gates.push_back(std::move(gate));
  };
  add(position_gates(parts, facts.options));
  auto study = fit::contour_study(parts, facts.options);
  if (!study) {
    add(failed_gates(study.error()));
    return tl::unexpected(study.error());
  }
  facts.study = *std::move(study);
  facts.names = names_of(task, parts.size());
  add(contour_gates(result.feature.characteristics, facts));
  for (const core::Error& warning : facts.study.warnings) {
    if (!is_gate(warning, facts.options)) result.warnings.push_back(warning);
  }
  facts.study.warnings = result.warnings;  // said once
  facts.numbers = contour_numbers(facts, uncertainty_options(record));
  keep_words(facts);
  return facts;
}

}  // namespace rondure::evaluation
