#include "reports/drawings/internal/plot_scale.h"

#include <fmt/format.h>
#include <cmath>

#include "core/numbers.h"
#include "core/units.h"

namespace rondure::reports {

using core::signed_um;

void tick_below(Svg& svg, double x, double bottom, std::string_view label) {
  svg.line(x, bottom, x, bottom + 5.0, "tick");
  svg.text(x, bottom + 18.0, "middle", "label", label);
}

void tick_beside(Svg& svg, double left, double y, std::string_view label, double gap) {
  svg.line(left - 5.0, y, left, y, "tick");
  label_beside(svg, left, y, label, gap);
}

void label_beside(Svg& svg, double left, double y, std::string_view label, double gap) {
  svg.text(left - gap, y + 4.0, "end", "label", label);
}

void scale_bar(Svg& svg, int top, double length, double length_um) {
  svg.path(fmt::format("M8 {0}v8M8 {1}h{2:.1f}M{3:.1f} {0}v8", top, top + 4, length, 8.0 + length),
           "scale");
  svg.text(8.0, top - 6.0, "start", "label", tick_label(length_um) + " µm");
}

void draw_polar_axes(Svg& svg, const PolarAxes& axes) {
  const double middle = axes.centre;
  for (int tick = 0; tick < 12; ++tick) {
    const double angle = tick * 30.0 * core::kDegree;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const bool labelled = tick % 3 == 0;
    const double end = axes.edge + (labelled ? axes.labelled_tick : axes.tick);
    svg.line(middle + axes.edge * c, middle - axes.edge * s, middle + end * c, middle - end * s,
             "tick");
    if (labelled) svg.line(middle, middle, middle + axes.edge * c, middle - axes.edge * s, "grid");
  }
  svg.text(middle + axes.beside, middle + 4.0, "start", "label", "0°");
  svg.text(middle, middle - axes.above, "middle", "label", "90°");
  svg.text(middle - axes.beside, middle + 4.0, "end", "label", "180°");
  svg.text(middle, middle + axes.above + 9.0, "middle", "label", "270°");
}

void draw_section_point(Svg& svg, double x, double y, const evaluation::CloudPoint& point,
                        double radius) {
  if (point.outer_contact) {
    svg.triangle(x, y, 5.5, "outer");
  } else if (point.inner_contact) {
    svg.square(x, y, 5.0, "inner");
  } else if (radius > 0.0) {
    svg.circle(x, y, radius, "point");
  }
}

void deviation_scale(Svg& svg, double x, double top, double bottom, double half_zone_mm) {
  constexpr int kSteps = 41;
  constexpr double kBar = 14.0;
  const double from = top + 18.0;
  const double height = (bottom - from) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double ratio = 1.0 - 2.0 * i / (kSteps - 1.0);
    svg.rect(x, from + i * height, kBar, height + 0.4, "swatch", diverging_colour(ratio));
  }
  svg.rect(x, from, kBar, kSteps * height, "frame");
  svg.text(x, top + 6.0, "start", "title", "µm");
  const Scale y{-half_zone_mm, half_zone_mm, from + kSteps * height, from};
  for (const int part : {-2, -1, 0, 1, 2}) {
    const double value = 0.5 * part * half_zone_mm;
    const double shift = part == 2 ? 7.0 : part == -2 ? 1.0 : 4.0;
    svg.line(x + kBar, y.at(value), x + kBar + 4.0, y.at(value), "tick");
    svg.text(x + kBar + 7.0, y.at(value) + shift, "start", "label",
             part == 0 ? "0" : signed_um(value));
  }
}

}  // namespace rondure::reports
