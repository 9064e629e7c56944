#include "reports/warnings.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"

namespace rondure::reports {
namespace {

constexpr double kGapLimit =
    120.0 * core::kDegree;              // beyond it the certificate of a section needs care
constexpr std::size_t kFewPoints = 21;  // 3 layers of 7

void add(FeatureResult& result, core::Code code, std::string what) {
  result.warnings.push_back({code, std::move(what), {}});
}

/// Largest angle about the axis without a point.
double largest_gap(const std::vector<CloudPoint>& cloud) {
  std::vector<double> angles;
  for (const CloudPoint& point : cloud) angles.push_back(point.angle_rad);
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + core::kTwoPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap;
}

void warn_sampling(FeatureResult& result) {
  const record::Feature& feature = result.feature;
  const bool cylinder = feature.shape == record::Shape::kCylinder;
  const bool sparse = feature.layers > 0
                          ? feature.points_per_layer < 7 || (cylinder && feature.layers < 3)
                          : result.cloud.size() < (cylinder ? kFewPoints : kFewPoints / 3);
  if (sparse) {
    add(result, core::Code::kSparse,
        fmt::format(
            "{} points see only part of the form; the deviation of the whole surface is larger",
            result.cloud.size()));
  }
  const double gap = largest_gap(result.cloud);
  if (gap > kGapLimit) {
    add(result, core::Code::kNotFullSection,
        fmt::format(
            "a gap of {:.0f} deg about the axis holds no point: the deviation is that of an arc, "
            "and its axis is weakly determined",
            gap / core::kDegree));
  }
}

void warn_exact_fit(FeatureResult& result) {
  for (const LayerResult& layer : result.layers) {
    if (!layer.mz || !layer.mz->exact_fit) continue;
    add(result, core::Code::kExactFit,
        fmt::format(
            "layer {} has three different points, which lie on a circle exactly: its roundness "
            "of 0 says nothing about the part",
            layer.layer + 1));
    return;
  }
}

void warn_level(FeatureResult& result) {
  if (!result.mz_cylinder) return;
  const double zone = result.mz_cylinder->width_mm();
  for (const PoseValue& value : result.poses) {
    if (!value.final_pose || !value.valid || !(value.f_mm > 2.0 * zone)) continue;
    add(result, core::Code::kNotLevel,
        fmt::format(
            "f = {:.3f} um in the final pose is more than twice the zone of {:.3f} um: it "
            "measures the tilt of the part, not its form; the minimum zone below is free of it",
            value.f_mm / core::kMicrometre, zone / core::kMicrometre));
    return;
  }
}

}  // namespace

void warn(FeatureResult& result) {
  warn_sampling(result);
  warn_exact_fit(result);
  if (result.mz_cylinder && result.mz_cylinder->certificate.kind == fit::Certificate::Kind::kNone) {
    add(result, core::Code::kNoCertificate, result.mz_cylinder->certificate.reason);
  }
  warn_level(result);
}

}  // namespace rondure::reports
