#include "evaluation/results/section.h"

#include <algorithm>
#include <optional>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

/// Keeps the least and the greatest deviation of each sector, so that no peak is lost.
std::vector<SectionPoint> thinned(const std::vector<SectionPoint>& profile) {
  struct Extremes {
    std::optional<SectionPoint> low, high;
  };
  std::vector<Extremes> sectors(kSectors);
  for (const SectionPoint& point : profile) {
    const double turn = point.angle_rad / core::kTwoPi * static_cast<double>(kSectors);
    const auto sector =
        static_cast<std::size_t>(std::clamp(turn, 0.0, static_cast<double>(kSectors - 1)));
    auto& [low, high] = sectors[sector];
    if (!low || point.deviation_mm < low->deviation_mm) low = point;
    if (!high || point.deviation_mm > high->deviation_mm) high = point;
  }
  std::vector<SectionPoint> result;
  for (const auto& [low, high] : sectors) {
    if (!low) continue;
    const bool low_first = low->angle_rad <= high->angle_rad;
    result.push_back(low_first ? *low : *high);
    result.push_back(low_first ? *high : *low);
  }
  return result;
}

void fill_profile(Section& section, const std::vector<CloudPoint>& cloud) {
  for (const std::size_t row : section.rows) {
    section.profile.push_back({cloud[row].angle_rad, cloud[row].deviation_mm});
  }
  std::stable_sort(section.profile.begin(), section.profile.end(),
                   [](const auto& a, const auto& b) { return a.angle_rad < b.angle_rad; });
  if (section.profile.size() > 4 * kSectors) {
    section.profile = thinned(section.profile);
    section.thinned = true;
  }
  const double pitch =
      core::kTwoPi / static_cast<double>(std::max<std::size_t>(1, section.profile.size()));
  section.widest_gap_rad = std::clamp(2.5 * pitch, 30.0 * core::kDegree, 150.0 * core::kDegree);
}

}  // namespace

bool has_marks(const Section& section) {
  return section.projected ? !section.thinned : section.rows.size() <= kMostMarks;
}

bool has_line(const Section& section) { return !section.projected || section.thinned; }

std::vector<Section> sections_of(const FeatureResult& feature) {
  std::vector<Section> sections;
  for (const LayerResult& layer : feature.layers) {
    Section section;
    section.layer = layer.layer;
    section.height_mm = layer.height_mm;
    for (const std::size_t row : layer.rows) {
      if (row < feature.cloud.size()) section.rows.push_back(row);
    }
    if (!section.rows.empty()) sections.push_back(std::move(section));
  }
  if (sections.empty() && !feature.cloud.empty()) {
    Section all;
    all.projected = true;
    for (std::size_t row = 0; row < feature.cloud.size(); ++row) {
      if (!feature.cloud[row].left_out) all.rows.push_back(row);
    }
    sections.push_back(std::move(all));
  }
  for (Section& section : sections) fill_profile(section, feature.cloud);
  return sections;
}

fit::Axis section_axis(const FeatureResult& feature, const LayerResult& layer,
                       const Eigen::Vector2d& center_mm) {
  fit::Axis frame = feature.section_axis;
  if (feature.mz_cylinder) {
    frame = feature.mz_cylinder->axis;
    frame.point_mm += layer.height_mm * frame.direction;
  }
  return {frame.point_mm + fit::across(frame.direction) * center_mm, frame.direction};
}

std::pair<double, double> heights_of(const FeatureResult& feature) {
  if (feature.cloud.empty()) return {0.0, 0.0};
  const auto [low, high] = std::minmax_element(
      feature.cloud.begin(), feature.cloud.end(),
      [](const CloudPoint& a, const CloudPoint& b) { return a.height_mm < b.height_mm; });
  return {low->height_mm, high->height_mm};
}

}  // namespace rondure::evaluation
