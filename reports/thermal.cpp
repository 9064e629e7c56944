#include "reports/thermal.h"

#include <cmath>

namespace rondure::reports {
namespace {

using record::RunRecord;
using record::Touch;

constexpr double kReference_degC = 20.0;

bool asks(const record::Feature& feature) {
  return feature.number("part_expansion_per_K") || feature.number("scale_expansion_per_K");
}

double part_factor(const ThermalCorrection& c) {
  return 1.0 + c.part_expansion_1_K * (c.part_degC - kReference_degC);
}

double scale_factor(double expansion_1_K, double degC) {
  return 1.0 + expansion_1_K * (degC - kReference_degC);
}

/// Mean temperatures of the touches that measure in a pose.
void take_means(const RunRecord& record, int pose, ThermalCorrection& out) {
  int count = 0;
  double part = 0.0;
  double scale = 0.0;
  for (const Touch& touch : record.touches) {
    if (touch.pose != pose || touch.purpose == Touch::Purpose::kQualification) continue;
    part += touch.temperature_degC - kReference_degC;
    scale += touch.scale_temperature_degC - kReference_degC;
    ++count;
  }
  if (count == 0) return;
  out.part_degC = kReference_degC + part / count;
  out.scale_degC = kReference_degC + scale / count;
}

double uncertainty(const record::Feature& feature, const ThermalCorrection& c) {
  const double u_K = feature.number("temperature_uncertainty_K").value_or(0.0);
  const double u_part = feature.number("part_expansion_uncertainty_per_K").value_or(0.0);
  const double u_scale = feature.number("scale_expansion_uncertainty_per_K").value_or(0.0);
  return std::hypot(
      std::hypot(c.part_expansion_1_K * u_K, (c.part_degC - kReference_degC) * u_part),
      std::hypot(c.scale_expansion_1_K * u_K, (c.scale_degC - kReference_degC) * u_scale));
}

}  // namespace

std::optional<ThermalCorrection> thermal_correction(const RunRecord& record, int feature,
                                                    int pose) {
  const record::Feature& asked = record.features[static_cast<std::size_t>(feature)];
  if (!asks(asked)) return std::nullopt;
  ThermalCorrection out;
  out.part_expansion_1_K = asked.number("part_expansion_per_K").value_or(0.0);
  out.scale_expansion_1_K = asked.number("scale_expansion_per_K").value_or(0.0);
  take_means(record, pose, out);
  out.factor = scale_factor(out.scale_expansion_1_K, out.scale_degC) / part_factor(out);
  out.factor_uncertainty = uncertainty(asked, out);
  return out;
}

std::optional<RunRecord> compensated(const RunRecord& record) {
  std::optional<RunRecord> out;
  double scales_1_K = 0.0;  // of the machine: alike for every feature
  for (const record::PoseVisit& visit : record.poses) {
    const auto correction = thermal_correction(record, visit.feature, visit.id);
    if (!correction) continue;
    if (!out) out = record;
    scales_1_K = correction->scale_expansion_1_K;
    for (Touch& touch : out->touches) {
      if (touch.pose != visit.id || touch.purpose == Touch::Purpose::kQualification) continue;
      touch.tip_mm *=
          scale_factor(scales_1_K, touch.scale_temperature_degC) / part_factor(*correction);
    }
  }
  if (!out) return std::nullopt;
  for (Touch& touch : out->touches) {
    if (touch.purpose != Touch::Purpose::kQualification) continue;
    touch.tip_mm *= scale_factor(scales_1_K, touch.scale_temperature_degC);
  }
  return out;
}

}  // namespace rondure::reports
