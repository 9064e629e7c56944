#include "evaluation/results/thermal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using record::RunRecord;
using record::Touch;

constexpr double kReference_degC = 20.0;

double part_factor(const ThermalCorrection& c) {
  return 1.0 + c.part_expansion_1_K * (c.part_degC - kReference_degC);
}

double scale_factor(double expansion_1_K, double degC) {
  return 1.0 + expansion_1_K * (degC - kReference_degC);
}

/// Mean temperatures of the measuring touches in a pose, for those expansions that `out` has.
/// @return  false: a temperature that is needed is neither measured nor declared.
bool take_means(const RunRecord& record, int pose, ThermalCorrection& out) {
  const std::optional<double> assumed = assumed_degC(record);
  const auto known = [&](const std::optional<double>& measured) {
    return measured ? measured : assumed;
  };
  int count = 0;
  double part = 0.0;
  double scale = 0.0;
  for (const Touch& touch : record.touches) {
    const bool qualifies = touch.purpose == Touch::Purpose::kQualification;
    if (touch.pose != pose && !qualifies) continue;
    const auto part_degC = known(touch.temperature_degC);
    const auto scale_degC = known(touch.scale_temperature_degC);
    if (out.scale_expansion_1_K != 0.0 && !scale_degC) return false;
    if (qualifies) continue;
    if (out.part_expansion_1_K != 0.0 && !part_degC) return false;
    part += part_degC.value_or(kReference_degC) - kReference_degC;
    scale += scale_degC.value_or(kReference_degC) - kReference_degC;
    ++count;
  }
  if (count == 0) return true;
  out.part_degC = kReference_degC + part / count;
  out.scale_degC = kReference_degC + scale / count;
  return true;
}

/// Range of the temperatures of one place.
struct Range {
  double least = HUGE_VAL;
  double greatest = -HUGE_VAL;
  int count = 0;

  void add(double degC) {
    least = std::min(least, degC);
    greatest = std::max(greatest, degC);
    ++count;
  }
};

void widen(std::optional<double>& drift_K, const Range& place) {
  if (place.count < 2) return;
  drift_K = std::max(drift_K.value_or(0.0), place.greatest - place.least);
}

/// Adds a temperature to the range and to the mean of those so far.
void add(double degC, double& count, Temperatures& out) {
  out.least_degC = count == 0.0 ? degC : std::min(out.least_degC, degC);
  out.greatest_degC = count == 0.0 ? degC : std::max(out.greatest_degC, degC);
  out.mean_degC += (degC - out.mean_degC) / ++count;
}

core::Result<record::ExpansionSettings> expansion_of(const record::Feature& feature) {
  return record::task_of<record::ExpansionSettings>(feature.settings);
}

double uncertainty(const record::ExpansionSettings& said, const ThermalCorrection& c) {
  const double u_K = said.temperature_uncertainty_K.value_or(0.0);
  const double u_part = said.part_expansion_uncertainty_per_K.value_or(0.0);
  const double u_scale = said.scale_expansion_uncertainty_per_K.value_or(0.0);
  return std::hypot(
      std::hypot(c.part_expansion_1_K * u_K, (c.part_degC - kReference_degC) * u_part),
      std::hypot(c.scale_expansion_1_K * u_K, (c.scale_degC - kReference_degC) * u_scale));
}

}  // namespace

std::optional<double> assumed_degC(const RunRecord& record) {
  const auto said = record::task_of<record::EnvironmentSettings>(record.settings, "environment/");
  return said ? said->assumed_degC : std::nullopt;
}

std::optional<Temperatures> temperatures_of(const RunRecord& record,
                                            const std::vector<const Touch*>& touches) {
  const std::optional<double> assumed = assumed_degC(record);
  if (touches.empty()) {
    if (!assumed) return std::nullopt;
    return Temperatures{*assumed, *assumed, *assumed, true, {}};
  }
  Temperatures out;
  double count = 0.0;
  std::map<std::pair<int, int>, Range> places;  // by layer and point
  for (const Touch* touch : touches) {
    const auto degC = touch->temperature_degC ? touch->temperature_degC : assumed;
    if (!degC) return std::nullopt;
    out.declared = out.declared || !touch->temperature_degC;
    add(*degC, count, out);
    if (touch->temperature_degC) places[{touch->layer, touch->point}].add(*degC);
  }
  for (const auto& [place, range] : places) widen(out.drift_K, range);
  return out;
}

std::optional<Temperatures> temperatures_of_series(const RunRecord& record, int feature) {
  const std::optional<double> assumed = assumed_degC(record);
  Temperatures out;
  double count = 0.0;
  for (const record::Series& series : record.series) {
    if (series.feature != feature || series.role != record::Series::Role::kData) continue;
    const auto column = series.column("temperature_degC");
    Range range;
    double mean_degC = 0.0;
    for (const double degC : column.value_or(std::vector<double>())) {
      range.add(degC);
      mean_degC += (degC - mean_degC) / range.count;
    }
    if (range.count == 0) {
      if (!assumed) return std::nullopt;
      out.declared = true;
      mean_degC = *assumed;
    }
    widen(out.drift_K, range);
    add(mean_degC, count, out);
  }
  return count == 0.0 ? temperatures_of(record, {}) : out;
}

bool asks_for_20_degC(const record::Feature& feature) {
  const auto said = expansion_of(feature);
  return !said || said->part_expansion_per_K || said->scale_expansion_per_K;
}

std::optional<ThermalCorrection> thermal_correction(const RunRecord& record, int feature,
                                                    int pose) {
  const record::Feature& asked = record.features[static_cast<std::size_t>(feature)];
  const auto said = expansion_of(asked);
  if (!asks_for_20_degC(asked) || !said) return std::nullopt;
  ThermalCorrection out;
  out.part_expansion_1_K = said->part_expansion_per_K.value_or(0.0);
  out.scale_expansion_1_K = said->scale_expansion_per_K.value_or(0.0);
  if (!take_means(record, pose, out)) return std::nullopt;
  out.factor = scale_factor(out.scale_expansion_1_K, out.scale_degC) / part_factor(out);
  out.factor_uncertainty = uncertainty(*said, out);
  return out;
}

std::optional<RunRecord> compensated(const RunRecord& record) {
  std::optional<RunRecord> out;
  const double assumed = assumed_degC(record).value_or(kReference_degC);
  double scales_1_K = 0.0;  // one value of the machine for every feature
  for (const record::PoseVisit& visit : record.poses) {
    const auto correction = thermal_correction(record, visit.feature, visit.id);
    if (!correction) continue;
    if (!out) out = record;
    // Points of a file have none.
    scales_1_K = std::max(scales_1_K, correction->scale_expansion_1_K);
    for (Touch& touch : out->touches) {
      if (touch.pose != visit.id || touch.purpose == Touch::Purpose::kQualification) continue;
      touch.tip_mm *= scale_factor(correction->scale_expansion_1_K,
                                   touch.scale_temperature_degC.value_or(assumed)) /
                      part_factor(*correction);
    }
  }
  if (!out) return std::nullopt;
  for (Touch& touch : out->touches) {
    if (touch.purpose != Touch::Purpose::kQualification) continue;
    touch.tip_mm *= scale_factor(scales_1_K, touch.scale_temperature_degC.value_or(assumed));
  }
  return out;
}

}  // namespace rondure::evaluation
