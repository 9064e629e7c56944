#include <algorithm>

#include <fmt/format.h>

#include "core/round_values.h"
#include "core/units.h"
#include "evaluation/section.h"
#include "reports/drawings/internal/plot_scale.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/plots.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

constexpr double kProfileWidth = 680.0;
constexpr double kProfileHeight = 250.0;
constexpr double kProfileLeft = 62.0;
constexpr double kProfileRight = 664.0;
constexpr double kProfileTop = 12.0;
constexpr double kProfileBottom = 204.0;

void draw_axes(Svg& svg, const Scale& x, const Scale& y, double half_zone_um) {
  svg.rect(kProfileLeft, y.at(half_zone_um), kProfileRight - kProfileLeft,
           y.at(-half_zone_um) - y.at(half_zone_um), "band");
  svg.line(kProfileLeft, y.at(half_zone_um), kProfileRight, y.at(half_zone_um), "zone-outer");
  svg.line(kProfileLeft, y.at(-half_zone_um), kProfileRight, y.at(-half_zone_um), "zone-inner");
  svg.line(kProfileLeft, y.at(0.0), kProfileRight, y.at(0.0), "mean");
  svg.rect(kProfileLeft, kProfileTop, kProfileRight - kProfileLeft, kProfileBottom - kProfileTop,
           "frame");
  for (int angle = 0; angle <= 360; angle += 45) {
    tick_below(svg, x.at(angle), kProfileBottom, std::to_string(angle));
  }
  svg.text(0.5 * (kProfileLeft + kProfileRight), kProfileBottom + 36.0, "middle", "title",
           tr("angle about the centre / °"));
  for (const double value : core::round_ticks(y.low, y.high, 6)) {
    tick_beside(svg, kProfileLeft, y.at(value), tick_label(value));
  }
  svg.upward_text(14.0, 0.5 * (kProfileTop + kProfileBottom), "title", tr("deviation / µm"));
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

}  // namespace

std::string section_profile(const evaluation::FeatureResult& feature,
                            const evaluation::Zone& zone) {
  const std::vector<evaluation::Section> sections = sections_of(feature);
  if (sections.empty()) return {};
  const evaluation::Section& section = sections.front();
  const double half_zone_um = std::max(0.5 * zone.deviation_mm / core::kMicrometre, 1e-2);
  const Scale x{0.0, 360.0, kProfileLeft, kProfileRight};
  const Scale y{-1.25 * half_zone_um, 1.25 * half_zone_um, kProfileBottom, kProfileTop};
  Svg svg(kProfileWidth, kProfileHeight, "wide", tr("Deviation against the angle"));
  draw_axes(svg, x, y, half_zone_um);
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

}  // namespace rondure::reports
