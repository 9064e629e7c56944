#include "evaluation/internal/truth.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "evaluation/results/finding.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

constexpr double kReference_degC = 20.0;
constexpr std::size_t kColumns = 4;

void take_tips(const record::Series& truth, record::RunRecord& out) {
  if (truth.columns.size() != kColumns) return;
  const auto last = static_cast<double>(out.touches.size());
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    const double* const numbers = &truth.values[kColumns * row];
    if (!(numbers[0] >= 0.0 && numbers[0] < last)) continue;
    out.touches[static_cast<std::size_t>(numbers[0])].tip_mm = {numbers[1], numbers[2], numbers[3]};
  }
}

/// The values of a characteristic that are judged; of one that find() does not compute, the value.
/// Of a mask none: the harmonic nearest to its limit may be another one without errors.
std::vector<double> values_of(const CharacteristicResult& result) {
  std::vector<double> out;
  if (result.finding) {
    for (const JudgedValue& judged : result.finding->judged) out.push_back(judged.value_mm);
  } else if (const auto value = result.value_mm();
             value && result.characteristic.form != record::Form::kHarmonicLimits) {
    out.push_back(*value);
  }
  return out;
}

}  // namespace

std::optional<record::RunRecord> without_errors(const record::RunRecord& measured) {
  constexpr auto kTruth = record::Series::Role::kTruth;
  if (std::ranges::find(measured.series, kTruth, &record::Series::role) == measured.series.end()) {
    return std::nullopt;
  }
  record::RunRecord out = measured;
  bool any = false;
  for (record::Series& series : out.series) {
    const record::Series* const truth = measured.truth_series_of(series.feature, series.name);
    const bool is_data = series.role == record::Series::Role::kData;
    if (is_data && truth != nullptr && truth->columns.size() == series.columns.size()) {
      series.values = truth->values;
      any = true;
    } else if (!is_data && series.name == record::kTrueTips) {
      take_tips(series, out);
      any = true;
    }
  }
  if (!any) return std::nullopt;
  for (record::Touch& touch : out.touches) {
    touch.temperature_degC = touch.scale_temperature_degC = kReference_degC;
  }
  // The fixture carried the part as it should: there is nothing to solve for.
  for (record::Feature& feature : out.features) {
    const auto merge = std::ranges::find(feature.settings, "merge", &record::Setting::name);
    if (merge != feature.settings.end()) merge->text = name_of(record::Merge::kKinematics);
  }
  std::erase_if(out.series, [](const record::Series& series) { return series.role == kTruth; });
  std::erase_if(out.settings, [](const record::Setting& setting) {
    return setting.name.starts_with("uncertainty/") || setting.name.starts_with("fixture/calibrat");
  });
  return out;
}

void keep_truths(const record::RunRecord& measured, const Evaluation& truth, Evaluation& out) {
  const auto known = [&](std::size_t feature) {
    const auto index = static_cast<int>(feature);
    if (measured.truth_series_of(index, record::kTrueTips) != nullptr) return true;
    return std::ranges::any_of(measured.series, [&](const record::Series& series) {
      return series.feature == index && series.role == record::Series::Role::kData &&
             measured.truth_series_of(index, series.name) != nullptr;
    });
  };
  for (std::size_t f = 0; f < out.features.size() && f < truth.features.size(); ++f) {
    auto& here = out.features[f].characteristics;
    const auto& there = truth.features[f].characteristics;
    for (std::size_t c = 0; known(f) && c < here.size() && c < there.size(); ++c) {
      const auto& finding = here[c].finding;
      const bool all_known =
          !finding || std::ranges::all_of(finding->datums, [&](const DatumResult& datum) {
            return std::ranges::all_of(datum.features, known);
          });
      std::vector<double> values = values_of(there[c]);
      if (all_known && values.size() == values_of(here[c]).size())
        here[c].truths_mm = std::move(values);
    }
  }
}

}  // namespace rondure::evaluation
