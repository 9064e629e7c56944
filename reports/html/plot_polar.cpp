#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/section.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::um;

constexpr double kSectionSize = 320.0;
constexpr double kSectionCentre = 160.0;
constexpr double kSectionMean = 88.0;      ///< Radius at which the middle of the zone is drawn.
constexpr double kSectionHalfZone = 24.0;  ///< Half the zone as drawn.
constexpr std::size_t kMostPlots = 12;

/// Places deviations on a polar plot.
struct PolarView {
  double px_per_mm = 1.0;
  double mean = kSectionMean;

  [[nodiscard]] double radius(double deviation_mm) const { return mean + px_per_mm * deviation_mm; }
  [[nodiscard]] double x(double angle_rad, double r) const {
    return kSectionCentre + r * std::cos(angle_rad);
  }
  [[nodiscard]] double y(double angle_rad, double r) const {
    return kSectionCentre - r * std::sin(angle_rad);
  }
};

void draw_zone(Svg& svg, const PolarView& view, double half_zone_mm) {
  const double outer = view.radius(half_zone_mm);
  const double inner = view.radius(-half_zone_mm);
  svg.path(fmt::format(
               "M{0:.1f} {2:.1f}a{1:.1f} {1:.1f} 0 1 0 {3:.1f} 0a{1:.1f} {1:.1f} 0 1 0 {4:.1f} 0z"
               "M{5:.1f} {2:.1f}a{6:.1f} {6:.1f} 0 1 1 {7:.1f} 0a{6:.1f} {6:.1f} 0 1 1 {8:.1f} 0z",
               kSectionCentre - outer, outer, kSectionCentre, 2.0 * outer, -2.0 * outer,
               kSectionCentre - inner, inner, 2.0 * inner, -2.0 * inner),
           "band");
  svg.circle(kSectionCentre, kSectionCentre, outer, "zone-outer");
  svg.circle(kSectionCentre, kSectionCentre, inner, "zone-inner");
  svg.circle(kSectionCentre, kSectionCentre, view.mean, "mean");
}

/// The profile as a line that is straight in angle and deviation, not in the plane of the plot.
std::string profile_path(const evaluation::Section& section, const PolarView& view) {
  constexpr double kStep = 4.0 * core::kDegree;
  const std::vector<evaluation::SectionPoint>& points = section.profile;
  std::string d;
  bool pen_down = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const evaluation::SectionPoint& a = points[i];
    const evaluation::SectionPoint& b = points[(i + 1) % points.size()];
    const double gap = b.angle_rad - a.angle_rad + (i + 1 == points.size() ? core::kTwoPi : 0.0);
    if (!pen_down) {
      const double r = view.radius(a.deviation_mm);
      d += fmt::format("M{:.1f} {:.1f}", view.x(a.angle_rad, r), view.y(a.angle_rad, r));
    }
    pen_down = gap <= section.widest_gap_rad;
    if (!pen_down) continue;
    const int pieces = std::max(1, static_cast<int>(std::ceil(gap / kStep)));
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      const double r = view.radius((1.0 - t) * a.deviation_mm + t * b.deviation_mm);
      d += fmt::format("L{:.1f} {:.1f}", view.x(a.angle_rad + t * gap, r),
                       view.y(a.angle_rad + t * gap, r));
    }
  }
  return d;
}

/// Shades the sectors of a layer whose points all lie in windows.
/// @param all  The feature with these points.
void draw_windows(Svg& svg, const evaluation::Section& section, const PolarView& view,
                  const evaluation::FeatureResult& all) {
  std::vector<std::pair<double, bool>> points;  // by angle, and whether in a window
  for (const evaluation::CloudPoint& point : all.cloud) {
    if (point.layer == section.layer) points.emplace_back(point.angle_rad, point.left_out);
  }
  std::sort(points.begin(), points.end());
  const std::size_t count = points.size();
  const double inner = view.mean - 2.0 * kSectionHalfZone;
  const double outer = view.mean + kSectionHalfZone + 6.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!points[i].second || points[(i + count - 1) % count].second) continue;
    std::size_t last = i;
    while (last + 1 < i + count && points[(last + 1) % count].second) ++last;
    double to = points[last % count].first;
    if (to < points[i].first) to += core::kTwoPi;
    const double half_step = 0.5 * core::kTwoPi / static_cast<double>(count);
    const double begin = points[i].first - half_step;
    const double end = to + half_step;
    svg.path(fmt::format("M{0:.1f} {1:.1f}A{4:.1f} {4:.1f} 0 {5} 0 {2:.1f} {3:.1f}L{6:.1f} {7:.1f}"
                         "A{10:.1f} {10:.1f} 0 {5} 1 {8:.1f} {9:.1f}z",
                         view.x(begin, outer), view.y(begin, outer), view.x(end, outer),
                         view.y(end, outer), outer, end - begin > 0.5 * core::kTwoPi ? 1 : 0,
                         view.x(end, inner), view.y(end, inner), view.x(begin, inner),
                         view.y(begin, inner), inner),
             "window");
  }
}

void draw_points(Svg& svg, const evaluation::Section& section,
                 const evaluation::FeatureResult& feature, const PolarView& view) {
  const double size = !has_marks(section) ? 0.0 : section.rows.size() <= 60 ? 3.0 : 1.6;
  for (const std::size_t row : section.rows) {
    const evaluation::CloudPoint& point = feature.cloud[row];
    const double r = view.radius(point.deviation_mm);
    draw_section_point(svg, view.x(point.angle_rad, r), view.y(point.angle_rad, r), point, size);
  }
}

void draw_scale_bar(Svg& svg, const PolarView& view) {
  const double length_um = core::round_below(34.0 / view.px_per_mm / core::kMicrometre);
  const double length = length_um * core::kMicrometre * view.px_per_mm;
  scale_bar(svg, 303, length, length_um);
}

std::string roundness_of(const evaluation::FeatureResult& feature,
                         const evaluation::Section& section) {
  for (const evaluation::LayerResult& layer : feature.layers) {
    if (section.projected || section.layer != layer.layer) continue;
    return layer.mz ? fmt::format("RONt {} µm", um(layer.mz->width_mm())) : tr("no RONt");
  }
  return {};
}

/// A section in its zone, without words.
Svg section_drawing(const evaluation::FeatureResult& feature, const evaluation::Section& section,
                    const PolarView& view, double half_zone_mm,
                    const evaluation::FeatureResult& all) {
  Svg svg(kSectionSize, kSectionSize, "polar",
          trf("{}: deviations about the minimum-zone axis", title_of(section)));
  draw_polar_axes(svg, {kSectionCentre, view.mean + kSectionHalfZone + 6.0, 4.0, 7.0,
                        view.mean + 39.0, view.mean + 42.0});
  draw_zone(svg, view, half_zone_mm);
  if (!section.projected) draw_windows(svg, section, view, all);
  const bool sparse = section.rows.size() <= 40;
  if (has_line(section)) svg.path(profile_path(section, view), sparse ? "guide" : "profile");
  draw_points(svg, section, feature, view);
  draw_scale_bar(svg, view);
  return svg;
}

/// "at 12.000 mm", where the section has a height; "part z 34.6 … 35.2 mm" where its points stand
/// on a leaning part at several, so that a point of it is not said to lie elsewhere.
std::string height_of(const evaluation::FeatureResult& feature, const evaluation::Section& section,
                      const Drawn& drawn) {
  if (section.projected || feature.feature.shape != record::Shape::kCylinder) return {};
  if (!drawn.part_z) return trf("at {} mm", fixed(section.height_mm, 3));
  const auto height = [&](std::size_t row) { return feature.cloud[row].height_mm; };
  const auto [lowest, highest] = std::ranges::minmax_element(section.rows, {}, height);
  const std::string low = fixed(height(*lowest), 1);
  const std::string high = fixed(height(*highest), 1);
  return trf("part z {} mm", low == high ? low : fmt::format("{} … {}", low, high));
}

std::string plot(const evaluation::FeatureResult& feature, const evaluation::Section& section,
                 const PolarView& view, double half_zone_mm, const evaluation::FeatureResult& all,
                 const Drawn& drawn) {
  std::string caption = fmt::format("<b>{}</b>", escaped(title_of(section)));
  for (const std::string& part :
       {height_of(feature, section, drawn), roundness_of(feature, section)}) {
    if (!part.empty()) caption += " · " + part;
  }
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>",
                     section_drawing(feature, section, view, half_zone_mm, all).str(), caption);
}

std::string legend(std::size_t shown, std::size_t all, double magnification, bool thinned,
                   bool sparse) {
  std::string text = trf(
      "Deviations about the minimum-zone axis, magnified {}× against the radius, alike in all "
      "plots. "
      "Shaded: the zone. {} point on the outer circle, {} point on the inner circle.",
      fixed(magnification, 0),
      R"(<svg class="key" aria-hidden="true" viewBox="0 0 12 12" width="12" height="12"><path class="outer" )"
      R"(d="M6 1l5 10h-10z"/></svg>)",
      R"(<svg class="key" aria-hidden="true" viewBox="0 0 12 12" width="12" height="12"><rect class="inner" )"
      R"(x="1.5" y="1.5" width="9" height="9"/></svg>)");
  if (sparse) text += tr(" The line guides the eye only: nothing was measured between the points.");
  if (thinned) text += tr(" The line runs through the extremes of 0.5° sectors.");
  if (shown < all) {
    text += trf(" {} of {} layers are shown, evenly spaced; all are in report.json.", shown, all);
  }
  return R"(<p class="note">)" + text + "</p>";
}

}  // namespace

std::string polar_plots(const evaluation::FeatureResult& feature, const evaluation::Zone& zone,
                        const evaluation::FeatureResult* all, const Drawn& drawn) {
  const std::vector<evaluation::Section> sections = sections_of(feature);
  if (sections.empty()) return {};
  const double half_zone_mm = 0.5 * zone.deviation_mm;
  const PolarView view{kSectionHalfZone / std::max(half_zone_mm, 1e-5)};
  const std::size_t shown = std::min(sections.size(), kMostPlots);
  const evaluation::FeatureResult& measured = all != nullptr ? *all : feature;
  bool thinned = false;
  bool sparse = false;
  std::string plots;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t pick = shown == 1 ? 0 : i * (sections.size() - 1) / (shown - 1);
    thinned |= sections[pick].thinned;
    sparse |= has_line(sections[pick]) && sections[pick].rows.size() <= 40;
    plots += plot(feature, sections[pick], view, half_zone_mm, measured, drawn);
  }
  const double magnification = view.px_per_mm * zone.mean_radius_mm / kSectionMean;
  std::string words = legend(shown, sections.size(), magnification, thinned, sparse);
  if (std::ranges::any_of(measured.cloud, &evaluation::CloudPoint::left_out))
    words +=
        note(tr("Grey sectors: windows, whose points take no part in the values of the "
                "drawing."));
  return fmt::format(R"(<h3>{}</h3>{}<div class="multiples{}">{}</div>)", tr("Sections"), words,
                     shown == 1                 ? " single"
                     : shown == 2 || shown == 4 ? " pairs"
                                                : "",
                     plots);
}

std::string worst_section(const evaluation::FeatureResult& feature, const evaluation::Zone& zone,
                          const evaluation::FeatureResult& all, const Drawn& drawn) {
  const std::vector<evaluation::Section> sections = sections_of(feature);
  if (sections.empty()) return {};
  const auto holds = [&](const evaluation::Section& section) {
    return drawn.worst && std::ranges::find(section.rows, *drawn.worst) != section.rows.end();
  };
  const auto found = std::ranges::find_if(sections, holds);
  const evaluation::Section& section = found == sections.end() ? sections.front() : *found;
  constexpr double kMean = 94.0;
  const double half_zone_mm = 0.5 * zone.deviation_mm;
  const PolarView view{kSectionHalfZone / std::max(half_zone_mm, 1e-5), kMean};
  Svg svg = section_drawing(feature, section, view, half_zone_mm, all);
  std::vector<std::string> lines = {height_of(feature, section, drawn)};
  if (lines.front().empty())
    lines.front() = section.projected ? tr("All points") : title_of(section);
  lines.push_back(count(section.rows.size(), "point", "points"));
  lines.push_back(roundness_of(feature, section));
  if (lines.back().starts_with("RONt"))
    lines.push_back(tr("as read, unfiltered"));  // the value may be an estimate
  std::erase(lines, "");
  constexpr double kLine = 16.0;
  double y = kSectionCentre + 4.0 - 0.5 * kLine * static_cast<double>(lines.size() - 1);
  for (std::size_t i = 0; i < lines.size(); ++i, y += kLine)
    svg.text(kSectionCentre, y, "middle", i == 0 ? "said first" : "said", lines[i]);
  if (found != sections.end()) {
    const evaluation::CloudPoint& point = feature.cloud[*drawn.worst];
    const double r = view.radius(point.deviation_mm);
    svg.circle(view.x(point.angle_rad, r), view.y(point.angle_rad, r), 9.0, "worst");
  }
  return fmt::format(R"(<figure>{}<figcaption>{}</figcaption></figure>)", svg.str(),
                     tr("Shaded: the zone. Triangles touch its outer, squares its inner circle; "
                        "the ring: where it "
                        "is worst."));
}

}  // namespace rondure::reports
