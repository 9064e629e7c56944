#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/round_values.h"
#include "core/units.h"
#include "reports/drawings/internal/plot_scale.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/plots.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

constexpr double kFaceWidth = 520.0;
constexpr double kFaceHeight = 400.0;
constexpr double kFaceCentre = 200.0;         ///< x and y.
constexpr double kFaceEdge = 160.0;           ///< Where the axes begin, outside all points.
constexpr double kFacePoints = 148.0;         ///< Radius of the outermost point.
constexpr std::size_t kMostFaceDiscs = 1500;  ///< More points are averaged in squares.
constexpr double kSquare = 6.0;

void draw_radii(Svg& svg, double px_per_mm, double greatest_mm) {
  const double step_mm = core::round_below(0.5 * greatest_mm);
  for (double radius_mm = step_mm; radius_mm * px_per_mm <= kFacePoints; radius_mm += step_mm) {
    const double r = radius_mm * px_per_mm;
    svg.circle(kFaceCentre, kFaceCentre, r, "guide");
    const double aside = r * std::sqrt(0.5);
    svg.text(kFaceCentre + aside + 3.0, kFaceCentre + aside + 11.0, "start", "label",
             fmt::format("{} mm", tick_label(radius_mm)));
  }
}

/// Mean heights in squares, for the points of a scan.
void draw_squares(Svg& svg, const evaluation::FeatureResult& feature, double px_per_mm,
                  double half_zone_mm) {
  std::map<std::pair<int, int>, std::pair<double, int>> squares;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double r = point.height_mm * px_per_mm;
    auto& [sum, number] =
        squares[{static_cast<int>(std::floor(r * std::cos(point.angle_rad) / kSquare)),
                 static_cast<int>(std::floor(-r * std::sin(point.angle_rad) / kSquare))}];
    sum += point.deviation_mm;
    ++number;
  }
  for (const auto& [place, content] : squares) {
    svg.rect(kFaceCentre + kSquare * place.first, kFaceCentre + kSquare * place.second,
             kSquare + 0.2, kSquare + 0.2, "swatch",
             diverging_colour(content.first / content.second / half_zone_mm));
  }
}

}  // namespace

std::string face_map(const evaluation::FeatureResult& feature) {
  if (!feature.mz_plane || feature.cloud.empty()) return {};
  const double greatest_mm =
      std::ranges::max_element(feature.cloud, {}, &evaluation::CloudPoint::height_mm)->height_mm;
  if (!(greatest_mm > 0.0)) return {};
  const double px_per_mm = kFacePoints / greatest_mm;
  const double half_zone_mm = std::max(0.5 * feature.mz_plane->width_mm, 1e-5);
  const bool squares = feature.cloud.size() > kMostFaceDiscs;
  Svg svg(kFaceWidth, kFaceHeight, "wide face", tr("Heights over the face"));
  draw_polar_axes(svg, {kFaceCentre, kFaceEdge, 4.0, 7.0, 170.0, 172.0});
  if (squares) draw_squares(svg, feature, px_per_mm, half_zone_mm);
  const double disc =
      std::clamp(60.0 / std::sqrt(static_cast<double>(feature.cloud.size())), 2.5, 9.0);
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double x = kFaceCentre + px_per_mm * point.height_mm * std::cos(point.angle_rad);
    const double y = kFaceCentre - px_per_mm * point.height_mm * std::sin(point.angle_rad);
    if (!squares)
      svg.circle(x, y, disc, "disc", diverging_colour(point.deviation_mm / half_zone_mm));
    const double mark = squares ? 5.0 : std::max(0.55 * disc, 3.5);
    if (point.outer_contact) svg.triangle(x, y, mark, "outer");
    if (point.inner_contact) svg.square(x, y, mark, "inner");
  }
  draw_radii(svg, px_per_mm, greatest_mm);
  deviation_scale(svg, 420.0, 50.0, 350.0, half_zone_mm);
  return fmt::format(
      R"(<h3>{}</h3><figure><div class="scroll">{}</div><figcaption>{} {}</figcaption></figure>)",
      tr("Map of the face"), svg.str(),
      squares ? tr("Mean height over the middle of the zone, seen against the normal.")
              : tr("Height of each point over the middle of the zone, seen against the normal."),
      tr("Orange: out of the material; blue: into it. Triangles touch the upper, squares the lower "
         "plane of the zone."));
}

}  // namespace rondure::reports
