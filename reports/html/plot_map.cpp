#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/section.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/plots.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;

constexpr double kMapWidth = 680.0;
constexpr double kMapLeft = 62.0;
constexpr double kMapRight = 580.0;
constexpr double kSideMargin = 20.0;  ///< Free space beside 0 and 360 deg.
constexpr double kMapTop = 14.0;
constexpr std::size_t kMostDiscs = 1200;  ///< More points than this are averaged in cells.
constexpr int kMapCellColumns = 120;
constexpr int kMapCellRows = 48;  ///< Used where layers are unknown, or more than this.

struct MapView {
  Scale x;
  Scale y;
  double half_zone_mm = 1.0;
  double bottom = 0.0;
  double disc = 4.0;    ///< Radius of a disc.
  bool labels = false;  ///< Discs are wide enough to show their value.
  bool cells = false;   ///< Too many points for discs: means of cells are drawn.
  bool rows_are_layers = false;
  double row = 4.0;  ///< Height of a cell.

  [[nodiscard]] std::string colour(double deviation_mm) const {
    return diverging_colour(deviation_mm / half_zone_mm);
  }
};

/// Least distance between the heights of two neighbouring layers.
double closest_layers_mm(const evaluation::FeatureResult& feature) {
  std::vector<double> heights;
  for (const evaluation::LayerResult& layer : feature.layers) heights.push_back(layer.height_mm);
  std::sort(heights.begin(), heights.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < heights.size(); ++i) {
    least = std::min(least, heights[i] - heights[i - 1]);
  }
  return least;
}

std::size_t most_points_of_a_layer(const evaluation::FeatureResult& feature) {
  std::size_t most = 1;
  for (const evaluation::LayerResult& layer : feature.layers)
    most = std::max(most, layer.rows.size());
  return most;
}

/// Distance of neighbouring discs on a map of the given height: exact for points in layers, a
/// fraction of the mean distance where layers are unknown.
double disc_pitch(const evaluation::FeatureResult& feature, double plot, double layer_pitch) {
  constexpr double kPlotWidth = kMapRight - kMapLeft - 2.0 * kSideMargin;
  if (feature.layers.empty()) {
    return 0.6 * std::sqrt(kPlotWidth * plot / static_cast<double>(feature.cloud.size()));
  }
  return std::min(kPlotWidth / static_cast<double>(most_points_of_a_layer(feature)), layer_pitch);
}

double plot_height(const evaluation::FeatureResult& feature) {
  if (feature.layers.empty()) return 240.0;
  return std::clamp(48.0 * (static_cast<double>(feature.layers.size()) - 1.0), 130.0, 300.0);
}

MapView view_of(const evaluation::FeatureResult& feature, const evaluation::Zone& zone) {
  const auto [lowest, highest] =
      std::minmax_element(feature.cloud.begin(), feature.cloud.end(),
                          [](const evaluation::CloudPoint& a, const evaluation::CloudPoint& b) {
                            return a.height_mm < b.height_mm;
                          });
  const double low = lowest->height_mm;
  const double span = std::max(highest->height_mm - low, 1e-9);
  const double plot = plot_height(feature);
  const double layer_pitch = closest_layers_mm(feature) / span * plot;
  MapView view;
  view.half_zone_mm = std::max(0.5 * zone.deviation_mm, 1e-5);
  view.disc = std::clamp(0.46 * disc_pitch(feature, plot, layer_pitch), 1.5, 17.0);
  if (feature.merged) view.disc = std::min(6.0, 0.6 * view.disc);
  view.labels = view.disc >= 14.0;
  view.cells = feature.cloud.size() > kMostDiscs;
  view.rows_are_layers = feature.layers.size() >= 2 && feature.layers.size() <= kMapCellRows;
  view.row = view.rows_are_layers ? std::clamp(0.9 * layer_pitch, 2.0, 40.0) : plot / kMapCellRows;
  const double label = feature.merged ? 8.0 : 0.0;  // space for the number of the pose
  const double margin = (view.cells ? 0.5 * view.row : view.disc) + 8.0 + label;
  view.bottom = kMapTop + plot + 2.0 * margin;
  view.x = {0.0, 360.0, kMapLeft + kSideMargin, kMapRight - kSideMargin};
  view.y = {low, low + span, view.bottom - margin, kMapTop + margin};
  return view;
}

/// Frame of a drawing over the angle, given by its end; it begins at kMapLeft.
struct MapFrame {
  double right = kMapRight;
  double top = kMapTop;
  double bottom = 0.0;
};

/// Frame, ticks and titles of a drawing over the angle.
void draw_frame(Svg& svg, const MapFrame& frame, const Scale& x, const std::string& x_title,
                const Scale& y, int y_ticks, const std::string& y_title) {
  svg.rect(kMapLeft, frame.top, frame.right - kMapLeft, frame.bottom - frame.top, "frame");
  for (int angle = 0; angle <= 360; angle += 45) {
    tick_below(svg, x.at(angle), frame.bottom, std::to_string(angle));
  }
  svg.text(0.5 * (kMapLeft + frame.right), frame.bottom + 36.0, "middle", "title", x_title);
  for (const double value : core::round_ticks(y.low, y.high, y_ticks)) {
    tick_beside(svg, kMapLeft, y.at(value), tick_label(value));
  }
  svg.upward_text(14.0, 0.5 * (frame.top + frame.bottom), "title", y_title);
}

/// Three digits with their sign, short enough for a disc.
std::string disc_label(double deviation_mm) {
  const double value = deviation_mm / core::kMicrometre;
  const double size = std::abs(value);
  const int decimals = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  return fmt::format("{}{}", value > 0.0 ? "+" : "", fixed(value, decimals));
}

/// x of a disc: discs of one target in several poses stand side by side.
double disc_x(const evaluation::CloudPoint& point, const evaluation::FeatureResult& feature,
              const MapView& view) {
  const double x = view.x.at(point.angle_rad / core::kDegree);
  if (!feature.merged) return x;
  const double middle = 0.5 * (static_cast<double>(feature.merged->poses.size()) - 1.0);
  return x + 2.0 * view.disc * (point.pose - middle);
}

void draw_discs(Svg& svg, const evaluation::FeatureResult& feature, const MapView& view) {
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double x = disc_x(point, feature, view);
    const double y = view.y.at(point.height_mm);
    if (feature.merged)
      svg.text(x, y - view.disc - 1.0, "middle", "label", std::to_string(point.pose + 1));
    const bool contact = point.outer_contact || point.inner_contact;
    svg.circle(x, y, view.disc, contact ? "disc contact" : "disc", view.colour(point.deviation_mm));
    if (!view.labels) continue;
    const bool dark = std::abs(point.deviation_mm) > 0.62 * view.half_zone_mm;
    svg.text(x, y + 3.2, "middle", dark ? "value light" : "value", disc_label(point.deviation_mm));
  }
}

/// Height at which the cell of a point is centred: that of its layer, or of its row of cells.
double cell_height(const evaluation::CloudPoint& point, const std::map<int, double>& layer_heights,
                   const MapView& view) {
  const auto layer = layer_heights.find(point.layer);
  if (layer != layer_heights.end()) return layer->second;
  const double pitch = (view.y.high - view.y.low) / kMapCellRows;
  const double row = std::floor((point.height_mm - view.y.low) / pitch);
  return view.y.low + (std::clamp(row, 0.0, kMapCellRows - 1.0) + 0.5) * pitch;
}

void draw_cells(Svg& svg, const evaluation::FeatureResult& feature, const MapView& view) {
  std::map<int, double> layer_heights;
  if (view.rows_are_layers) {
    for (const evaluation::LayerResult& layer : feature.layers)
      layer_heights[layer.layer] = layer.height_mm;
  }
  std::map<std::pair<double, int>, std::pair<double, int>> cells;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const int column = std::clamp(
        static_cast<int>(point.angle_rad / core::kTwoPi * kMapCellColumns), 0, kMapCellColumns - 1);
    auto& [sum, number] = cells[{cell_height(point, layer_heights, view), column}];
    sum += point.deviation_mm;
    ++number;
  }
  const double width = (view.x.to - view.x.from) / kMapCellColumns;
  for (const auto& [place, content] : cells) {
    svg.rect(view.x.from + place.second * width, view.y.at(place.first) - 0.5 * view.row,
             width + 0.3, view.row + 0.1, "swatch", view.colour(content.first / content.second));
  }
}

void draw_contacts(Svg& svg, const evaluation::FeatureResult& feature, const MapView& view) {
  const double shift = view.labels && !view.cells ? view.disc - 1.0 : 0.0;
  const double size = view.labels && !view.cells ? 4.0 : 5.0;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double x = disc_x(point, feature, view) + 0.8 * shift;
    const double y = view.y.at(point.height_mm) - 0.8 * shift;
    if (point.outer_contact) svg.triangle(x, y, size, "outer");
    if (point.inner_contact) svg.square(x, y, size, "inner");
  }
}

constexpr double kProfileHeight = 250.0;
constexpr MapFrame kProfileFrame = {664.0, 12.0, 204.0};

void draw_zone(Svg& svg, const Scale& y, double half_zone_um) {
  const double right = kProfileFrame.right;
  svg.rect(kMapLeft, y.at(half_zone_um), right - kMapLeft, y.at(-half_zone_um) - y.at(half_zone_um),
           "band");
  svg.line(kMapLeft, y.at(half_zone_um), right, y.at(half_zone_um), "zone-outer");
  svg.line(kMapLeft, y.at(-half_zone_um), right, y.at(-half_zone_um), "zone-inner");
  svg.line(kMapLeft, y.at(0.0), right, y.at(0.0), "mean");
}

std::string profile_path(const evaluation::Section& section, const Scale& x, const Scale& y) {
  std::string d;
  for (std::size_t i = 0; i < section.profile.size(); ++i) {
    const evaluation::SectionPoint& point = section.profile[i];
    const bool connected =
        i > 0 && point.angle_rad - section.profile[i - 1].angle_rad <= section.widest_gap_rad;
    d +=
        fmt::format("{}{:.1f} {:.1f}", connected ? 'L' : 'M', x.at(point.angle_rad / core::kDegree),
                    y.at(point.deviation_mm / core::kMicrometre));
  }
  return d;
}

/// Deviation of one section against the angle.
std::string section_profile(const evaluation::FeatureResult& feature,
                            const evaluation::Zone& zone) {
  const std::vector<evaluation::Section> sections = sections_of(feature);
  if (sections.empty()) return {};
  const evaluation::Section& section = sections.front();
  const double half_zone_um = std::max(0.5 * zone.deviation_mm / core::kMicrometre, 1e-2);
  const Scale x{0.0, 360.0, kMapLeft, kProfileFrame.right};
  const Scale y{-1.25 * half_zone_um, 1.25 * half_zone_um, kProfileFrame.bottom, kProfileFrame.top};
  Svg svg(kMapWidth, kProfileHeight, "wide", tr("Deviation against the angle"));
  draw_zone(svg, y, half_zone_um);
  draw_frame(svg, kProfileFrame, x, tr("angle about the centre / °"), y, 6, tr("deviation / µm"));
  svg.path(profile_path(section, x, y), section.rows.size() <= 40 ? "guide" : "profile");
  const double size = !has_marks(section) ? 0.0 : section.rows.size() <= 60 ? 3.0 : 1.5;
  for (const std::size_t row : section.rows) {
    const evaluation::CloudPoint& point = feature.cloud[row];
    draw_section_point(svg, x.at(point.angle_rad / core::kDegree),
                       y.at(point.deviation_mm / core::kMicrometre), point, size);
  }
  return fmt::format(
      R"(<h3>{}</h3><figure><div class="scroll">{}</div><figcaption>{}</figcaption></figure>)",
      tr("Unrolled section"), svg.str(),
      tr("Deviation from the middle of the zone (shaded); triangles touch the outer, squares the "
         "inner circle."));
}

}  // namespace

std::string deviation_map(const evaluation::FeatureResult& feature, const evaluation::Zone& zone,
                          const Drawn& drawn) {
  if (feature.cloud.empty()) return {};
  const bool one_section =
      feature.feature.shape == record::Shape::kCircle || feature.layers.size() == 1;
  if (one_section) return section_profile(feature, zone);
  const MapView view = view_of(feature, zone);
  Svg svg(kMapWidth, view.bottom + 44.0, "wide", tr("Deviations on the unrolled surface"));
  draw_frame(svg, {kMapRight, kMapTop, view.bottom}, view.x, tr("angle about the axis / °"), view.y,
             5, drawn.part_z ? tr("part z / mm") : tr("height / mm"));
  if (view.cells) {
    draw_cells(svg, feature, view);
  } else {
    draw_discs(svg, feature, view);
  }
  draw_contacts(svg, feature, view);
  if (drawn.worst) {
    const evaluation::CloudPoint& point = feature.cloud[*drawn.worst];
    svg.circle(disc_x(point, feature, view), view.y.at(point.height_mm), view.disc + 6.0, "worst");
  }
  deviation_scale(svg, kMapRight + 22.0, kMapTop, view.bottom, view.half_zone_mm);
  return fmt::format(
      R"(<h3>{}</h3><figure><div class="scroll">{}</div><figcaption>{} {}{}</figcaption></figure>)",
      tr("Unrolled surface"), svg.str(),
      view.cells ? tr("Mean deviation from the middle of the zone, in cells of 3°.")
                 : tr("Deviation of each point from the middle of the zone in µm."),
      feature.feature.shape == record::Shape::kCylinder
          ? tr("Orange: farther from the axis; blue: nearer. Triangles touch the outer, squares "
               "the inner cylinder of the zone.")
          : tr("Orange: outwards; blue: inwards. Triangles touch the outer, squares the inner "
               "surface of the zone."),
      feature.merged ? tr(" The number above a point is its pose.") : std::string());
}

}  // namespace rondure::reports
