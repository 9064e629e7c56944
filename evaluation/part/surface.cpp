#include "evaluation/part/surface.h"

#include <algorithm>
#include <utility>

#include "evaluation/part/internal/layout.h"
#include "evaluation/results/measured_cloud.h"

namespace rondure::evaluation {
namespace {

std::shared_ptr<const SurfaceLayout> known_layout(const MeasuredSurface& surface) {
  if (surface.layout) return surface.layout;
  return std::make_shared<const SurfaceLayout>(layout_of(*surface.of));
}

}  // namespace

std::vector<MeasuredSurface> surfaces_of(std::span<const FeatureResult> features) {
  std::vector<MeasuredSurface> out;
  for (const FeatureResult& feature : features) {
    MeasuredSurface surface{.of = &feature, .tips_mm = {}, .tip_radius_mm = feature.tip_radius_mm};
    if (!record::is_analysis(feature.feature.shape)) {
      surface.tips_mm = tips_of(feature.cloud);
      surface.layout = std::make_shared<const SurfaceLayout>(layout_of(feature));
    }
    out.push_back(std::move(surface));
  }
  return out;
}

std::vector<LeftOut> rows_in_windows(const FeatureResult& feature) {
  const bool windows = std::ranges::any_of(
      feature.feature.settings,
      [](const record::Setting& setting) { return setting.name.starts_with("exclude/"); });
  return windows ? layout_of(feature).windows : std::vector<LeftOut>();
}

std::vector<std::vector<Eigen::Vector3d>> layers_of(const PreparedSurface& surface) {
  std::vector<std::vector<Eigen::Vector3d>> out;
  out.reserve(surface.sections.size());
  for (const SurfaceSection& section : surface.sections) {
    std::vector<Eigen::Vector3d>& layer = out.emplace_back();
    layer.reserve(section.points.size());
    for (const std::size_t i : section.points) layer.push_back(surface.points_mm[i]);
  }
  return out;
}

std::vector<std::size_t> outlying_rows(const MeasuredSurface& surface) {
  const auto layout = known_layout(surface);
  return layout->failure || layout->too_many ? std::vector<std::size_t>() : layout->outlying;
}

MeasuredSurface without_rows(const MeasuredSurface& surface, std::span<const std::size_t> rows) {
  SurfaceLayout layout = *known_layout(surface);
  if (layout.failure) return surface;
  layout.as_measured = false;
  for (const std::size_t row : rows) layout.kept[row] = false;
  for (SectionRows& section : layout.sections) {
    std::erase_if(section.rows, [&](std::size_t row) { return !layout.kept[row]; });
  }
  MeasuredSurface out = surface;
  out.layout = std::make_shared<const SurfaceLayout>(std::move(layout));
  return out;
}

}  // namespace rondure::evaluation
