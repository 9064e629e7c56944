#include "evaluation/internal/truth.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/harmonic_mask.h"
#include "evaluation/results/finding.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using record::RunRecord;
using record::Series;
using record::Shape;

constexpr double kReference_degC = 20.0;
constexpr std::size_t kTipColumns = 4;

/// What is read without errors: everything, or the poses of both axes that a calibration leaves
/// out.
enum class Exact { kAll, kBothAxes };

bool of_both_axes(const RunRecord& record, const record::Touch& touch) {
  const auto visit = std::ranges::find(record.poses, touch.pose, &record::PoseVisit::id);
  return visit != record.poses.end() &&
         record.features[static_cast<std::size_t>(visit->feature)].shape == Shape::kRotaryAxes &&
         visit->commanded.alpha_rad != 0.0 && visit->commanded.beta_rad != 0.0;
}

void take_tips(const Series& truth, Exact exact, RunRecord& out) {
  if (truth.columns.size() != kTipColumns) return;
  const auto last = static_cast<double>(out.touches.size());
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    const double* const numbers = &truth.values[kTipColumns * row];
    if (!(numbers[0] >= 0.0 && numbers[0] < last)) continue;
    record::Touch& touch = out.touches[static_cast<std::size_t>(numbers[0])];
    if (exact == Exact::kBothAxes && !of_both_axes(out, touch)) continue;
    touch.tip_mm = {numbers[1], numbers[2], numbers[3]};
  }
}

void take_rows(const Series& truth, Exact exact, Series& out) {
  if (truth.values.size() != out.values.size() || truth.columns.size() != out.columns.size())
    return;
  if (exact == Exact::kAll) {
    out.values = truth.values;
    return;
  }
  const auto step = out.column("step");  // of a head
  for (std::size_t row = 0; step && row < out.rows(); ++row) {
    if ((*step)[row] != static_cast<double>(fit::HeadStep::kVerification)) continue;
    const std::size_t width = out.columns.size();
    std::copy_n(&truth.values[row * width], width, &out.values[row * width]);
  }
}

RunRecord without_errors(const RunRecord& measured, Exact exact) {
  RunRecord out = measured;
  for (Series& series : out.series) {
    const Series* const truth = measured.truth_series_of(series.feature, series.name);
    if (truth == nullptr) continue;
    if (series.role == Series::Role::kData) {
      take_rows(*truth, exact, series);
    } else if (series.name == record::kTrueTips) {
      take_tips(*truth, exact, out);
    }
  }
  for (record::Touch& touch : out.touches) {
    touch.temperature_degC = touch.scale_temperature_degC = kReference_degC;
  }
  // The fixture carried the part as it should: there is nothing to solve for.
  for (record::Feature& feature : out.features) {
    const auto merge = std::ranges::find(feature.settings, "merge", &record::Setting::name);
    if (merge != feature.settings.end()) merge->text = name_of(record::Merge::kKinematics);
  }
  std::erase_if(out.series, [](const Series& s) { return s.role == Series::Role::kTruth; });
  std::erase_if(out.settings, [](const record::Setting& setting) {
    return setting.name.starts_with("uncertainty/") || setting.name.starts_with("fixture/calibrat");
  });
  return out;
}

/// Whether the hidden truth of a feature is on record: of touches, or beside its data.
bool knows_truth(const RunRecord& record, std::size_t feature) {
  const auto index = static_cast<int>(feature);
  if (record.truth_series_of(index, record::kTrueTips) != nullptr) return true;
  return std::ranges::any_of(record.series, [&](const Series& series) {
    return series.feature == index && series.role == Series::Role::kData &&
           record.truth_series_of(index, series.name) != nullptr;
  });
}

/// The values of a characteristic that are judged; of one that find() does not compute, the value.
std::vector<double> compared_values(const CharacteristicResult& result) {
  std::vector<double> out;
  if (result.finding) {
    for (const JudgedValue& judged : result.finding->judged) out.push_back(judged.value_mm);
  } else if (const auto value = result.value_mm()) {
    out.push_back(*value);
  }
  return out;
}

/// The amplitude of an order among others; nothing where it is not there.
template <class Harmonics, class Order>
std::vector<double> amplitude_of(const Harmonics& all, int number, Order order) {
  const auto found = std::ranges::find(all, number, order);
  return found == all.end() ? std::vector<double>() : std::vector<double>{found->amplitude_mm};
}

/// Of a mask: the harmonic that was judged, without errors. There another one may be nearest to its
/// limit.
std::vector<double> same_harmonic(const FeatureResult& measured, const FeatureResult& exact,
                                  const record::Characteristic& asked) {
  if (!measured.analysis) {
    const auto judged = nearest_to_mask(measured, asked);
    for (const LayerResult& layer : exact.layers) {
      if (!judged || layer.layer != judged->harmonic.layer || !layer.filtered) continue;
      return amplitude_of(layer.filtered->harmonics.harmonics, judged->harmonic.number,
                          &fit::Harmonic::number);
    }
    return {};
  }
  const auto judged = value_of(*measured.analysis, asked);
  if (!judged || !exact.analysis) return {};
  if (const auto* const spindle = std::get_if<SpindleResult>(&exact.analysis->found)) {
    return amplitude_of(spindle->separation.harmonics, judged->harmonic,
                        &fit::RecoveredHarmonic::order);
  }
  const auto* const pins = std::get_if<ContourResult>(&exact.analysis->found);
  if (pins == nullptr || judged->part >= pins->study.parts.size()) return {};
  return amplitude_of(fit::contour_harmonics(pins->study.parts[judged->part].pin.contour.error_mm,
                                             judged->harmonic),
                      judged->harmonic, &fit::Harmonic::number);
}

bool calibrates(const FeatureResult& feature) {
  if (!feature.analysis) return false;
  if (std::holds_alternative<RotaryResult>(feature.analysis->found)) return true;
  const auto* const head = std::get_if<FiveAxisResult>(&feature.analysis->found);
  return head != nullptr && !head->gain;  // a repeat reads what is left
}

/// Of a calibration: what it leaves in the poses of both axes.
bool is_left(record::Form form) {
  return form != record::Form::kLocation && form != record::Form::kAxisError;
}

/// What a calibration as found leaves where these poses are read without errors. Its balls are
/// known as well as it measured them: that is no error of the axes.
std::vector<double> left_values(const FeatureResult& exact, record::Form form) {
  const auto* const rotary = std::get_if<RotaryResult>(&exact.analysis->found);
  const auto left =
      moved_by(rotary != nullptr ? rotary->combined
                                 : std::get<FiveAxisResult>(exact.analysis->found).combined);
  const bool rms = form == record::Form::kFixtureResidualRms || form == record::Form::kLeftRms;
  return {rms ? left.rms_mm : left.max_mm};
}

}  // namespace

void hold_against_truth(const RunRecord& measured, const ValuesOf& values_of, Evaluation& out) {
  const auto known = [&](std::size_t feature) { return knows_truth(measured, feature); };
  std::optional<Evaluation> exact;
  std::optional<Evaluation> residuals;
  for (std::size_t f = 0; f < out.features.size(); ++f) {
    if (!known(f)) continue;
    if (!exact) exact = values_of(without_errors(measured, Exact::kAll));
    FeatureResult& here = out.features[f];
    here.exact = exact->features[f].analysis;
    const bool calibration = calibrates(here);
    if (calibration && !residuals)
      residuals = values_of(without_errors(measured, Exact::kBothAxes));
    for (std::size_t c = 0; c < here.characteristics.size(); ++c) {
      CharacteristicResult& result = here.characteristics[c];
      const bool left = calibration && is_left(result.characteristic.form);
      const FeatureResult& there = (left ? residuals : exact)->features[f];
      const bool all_known =
          !result.finding || std::ranges::all_of(result.finding->datums, [&](const auto& datum) {
            return std::ranges::all_of(datum.features, known);
          });
      if (!all_known || c >= there.characteristics.size()) continue;
      std::vector<double> values = compared_values(there.characteristics[c]);
      if (left && !values.empty()) values = left_values(there, result.characteristic.form);
      if (result.characteristic.form == record::Form::kHarmonicLimits)
        values = same_harmonic(here, there, result.characteristic);
      if (values.size() == compared_values(result).size()) result.truths_mm = std::move(values);
    }
  }
}

}  // namespace rondure::evaluation
