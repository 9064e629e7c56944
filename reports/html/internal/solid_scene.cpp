#include "reports/html/internal/solid_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/units.h"

namespace rondure::reports {
namespace {

constexpr double kSolidMean = 112.0;     ///< Radius at which the middle of the zone is drawn.
constexpr double kSolidHalfZone = 16.0;  ///< Half the zone as drawn.
constexpr double kLeastSolidHeight = 45.0;
constexpr double kMostSolidHeight = 138.0;  ///< For half the cylinder.
constexpr int kSolidCellColumns = 72;
constexpr int kSolidCellRows = 24;
constexpr std::size_t kRingSteps = 120;  ///< 3 deg.
constexpr std::size_t kMostSections = 24;

struct Scales {
  double middle_mm = 0.0;  ///< Height drawn at 0.
  double px_per_height_mm = 1.0;
  double px_per_deviation_mm = 1.0;

  [[nodiscard]] double height(double height_mm) const {
    return (height_mm - middle_mm) * px_per_height_mm;
  }
  [[nodiscard]] double radius(double deviation_mm) const {
    return kSolidMean + deviation_mm * px_per_deviation_mm;
  }
};

/// Rows of the cloud that are drawn, in the order of the cloud.
std::vector<std::size_t> rows_drawn(const evaluation::FeatureResult& feature,
                                    const SolidScene& scene) {
  const auto& cloud = feature.cloud;
  std::vector<std::size_t> rows;
  const bool all = cloud.size() <= kMostSolidPoints;
  std::map<int, std::size_t> farthest;
  const double pitch = std::max(scene.high_mm - scene.low_mm, 1e-9) / kSolidCellRows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (all || cloud[i].outer_contact || cloud[i].inner_contact) {
      rows.push_back(i);
      continue;
    }
    const int column =
        std::clamp(static_cast<int>(cloud[i].angle_rad / core::kTwoPi * kSolidCellColumns), 0,
                   kSolidCellColumns - 1);
    const int row = std::clamp(static_cast<int>((cloud[i].height_mm - scene.low_mm) / pitch), 0,
                               kSolidCellRows - 1);
    const auto [cell, fresh] = farthest.try_emplace(row * kSolidCellColumns + column, i);
    const double kept = std::abs(cloud[cell->second].deviation_mm);
    if (!fresh && std::abs(cloud[i].deviation_mm) > kept) cell->second = i;
  }
  for (const auto& [cell, i] : farthest) rows.push_back(i);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// The profile of a section every 3 deg, straight in angle and deviation between its points.
std::vector<double> radii_of(const evaluation::Section& section, const Scales& scales) {
  const std::vector<evaluation::SectionPoint>& points = section.profile;
  std::vector<double> radii(kRingSteps, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const evaluation::SectionPoint& a = points[i];
    const evaluation::SectionPoint& b = points[(i + 1) % points.size()];
    const double gap = b.angle_rad - a.angle_rad + (i + 1 == points.size() ? core::kTwoPi : 0.0);
    if (gap > section.widest_gap_rad || !(gap > 0.0)) continue;
    constexpr double kStep = core::kTwoPi / static_cast<double>(kRingSteps);
    for (double k = std::ceil(a.angle_rad / kStep); k * kStep < a.angle_rad + gap; k += 1.0) {
      const double t = (k * kStep - a.angle_rad) / gap;
      radii[static_cast<std::size_t>(k) % kRingSteps] =
          scales.radius((1.0 - t) * a.deviation_mm + t * b.deviation_mm);
    }
  }
  return radii;
}

void add_sections(SolidScene& scene, const evaluation::FeatureResult& feature,
                  const Scales& scales) {
  if (feature.layers.empty()) return;
  const std::vector<evaluation::Section> sections = sections_of(feature);
  const std::size_t shown = std::min(sections.size(), kMostSections);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t pick = shown == 1 ? 0 : i * (sections.size() - 1) / (shown - 1);
    const evaluation::Section& section = sections[pick];
    scene.dense |= section.rows.size() >= kRingSteps;
    scene.sections.push_back({scales.height(section.height_mm), radii_of(section, scales)});
  }
}

}  // namespace

SolidScene solid_scene_of(const evaluation::FeatureResult& feature, const evaluation::Zone& zone) {
  SolidScene scene;
  scene.outer = kSolidMean + kSolidHalfZone;
  scene.inner = kSolidMean - kSolidHalfZone;
  std::tie(scene.low_mm, scene.high_mm) = heights_of(feature);
  const double half_zone_mm = std::max(0.5 * zone.deviation_mm, 1e-5);
  const double half_span_mm = std::max(0.5 * (scene.high_mm - scene.low_mm), 1e-9);
  const double px_per_mm = kSolidMean / std::max(zone.mean_radius_mm, 1e-9);
  scene.half_height = std::clamp(half_span_mm * px_per_mm, kLeastSolidHeight, kMostSolidHeight);
  scene.height_share = scene.half_height / (half_span_mm * px_per_mm);
  const Scales scales{0.5 * (scene.low_mm + scene.high_mm), scene.half_height / half_span_mm,
                      kSolidHalfZone / half_zone_mm};
  scene.magnification = scales.px_per_deviation_mm / px_per_mm;
  for (const std::size_t row : rows_drawn(feature, scene)) {
    const evaluation::CloudPoint& point = feature.cloud[row];
    scene.points.push_back({row, point.angle_rad / core::kDegree, scales.radius(point.deviation_mm),
                            scales.height(point.height_mm)});
  }
  scene.left_out = feature.cloud.size() - scene.points.size();
  add_sections(scene, feature, scales);
  return scene;
}

SolidSeen seen(const SolidCamera& camera, double angle_deg, double radius, double height) {
  const double turned = (angle_deg + camera.yaw_deg) * core::kDegree;
  const double pitch = camera.pitch_deg * core::kDegree;
  const double away = radius * std::sin(turned);
  return {radius * std::cos(turned), -(away * std::sin(pitch) + height * std::cos(pitch)),
          away < 0.0};
}

}  // namespace rondure::reports
