#pragma once

#include <utility>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "fit/geometry/axis.h"

namespace rondure::evaluation {

/// A point of a section, prepared for drawing.
struct SectionPoint {
  double angle_rad = 0.0;
  double deviation_mm = 0.0;
};

/// The points of one section by angle.
struct Section {
  int layer = 0;  ///< Layer of the feature; meaningless for projected points.
  double height_mm = 0.0;
  std::vector<std::size_t> rows;      ///< Rows of the cloud.
  std::vector<SectionPoint> profile;  ///< By angle; thinned when there are very many points.
  bool thinned = false;
  /// Points of many heights: neighbours by angle are not neighbours on the surface.
  bool projected = false;
  double widest_gap_rad = 0.0;  ///< A line is not drawn across a wider gap.
};

/// Most points that a section shows as single marks; with more, only the line is drawn.
inline constexpr std::size_t kMostMarks = 400;
/// Sectors that keep their least and greatest deviation when a profile is thinned.
inline constexpr std::size_t kSectors = 720;

/// Whether the points are drawn as single marks joined by a line.
[[nodiscard]] bool has_marks(const Section& section);
[[nodiscard]] bool has_line(const Section& section);

/// The sections of a feature: its layers, or all points in one when its layers are unknown.
[[nodiscard]] std::vector<Section> sections_of(const FeatureResult& feature);

/// The axis through a centre of a section: the centre in the frame of the cloud, and the normal of
/// the plane. `center_mm` is one of the centres in `layer`.
[[nodiscard]] fit::Axis section_axis(const FeatureResult& feature, const LayerResult& layer,
                                     const Eigen::Vector2d& center_mm);

/// Least and greatest height of the cloud along its axis, from its mean point [mm].
[[nodiscard]] std::pair<double, double> heights_of(const FeatureResult& feature);

}  // namespace rondure::evaluation
