#include "reports/drawings/internal/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/escaping.h"

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

namespace {

using Rgb = std::array<double, 3>;

/// Colour at `t` in [0, 1] along equally spaced stops.
std::string between(std::span<const Rgb> stops, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double part = place - static_cast<double>(left);
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < 3; ++i) {
    mixed[i] =
        static_cast<int>(std::lround((1.0 - part) * stops[left][i] + part * stops[left + 1][i]));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

std::string fill_attribute(std::string_view fill) {
  return fill.empty() ? std::string() : fmt::format(R"( fill="{}")", fill);
}

}  // namespace

Svg::Svg(double width, double height, std::string_view css_class, std::string_view label)
    : body_(fmt::format(R"(<svg class="{}" viewBox="0 0 {:.0f} {:.0f}" width="{:.0f}" )"
                        R"(height="{:.0f}" role="img" aria-label="{}">)",
                        css_class, width, height, width, height, escaped(label))) {}

std::string Svg::document(std::string_view style) const {
  constexpr std::string_view kTag = "<svg";
  const std::size_t inside = body_.find('>') + 1;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\"{}<style>{}</style>{}</svg>\n",
      body_.substr(kTag.size(), inside - kTag.size()), style, body_.substr(inside));
}

void Svg::describe(std::string_view text) {
  body_ += fmt::format("<desc>{}</desc>", escaped(text));
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  body_ += fmt::format(R"(<line class="{}" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                       css_class, x1, y1, x2, y2);
}

void Svg::circle(double x, double y, double r, std::string_view css_class, std::string_view fill) {
  body_ += fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="{:.1f}"{}/>)", css_class, x,
                       y, r, fill_attribute(fill));
}

void Svg::rect(double x, double y, double w, double h, std::string_view css_class,
               std::string_view fill) {
  body_ +=
      fmt::format(R"(<rect class="{}" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"{}/>)",
                  css_class, x, y, w, h, fill_attribute(fill));
}

void Svg::path(std::string_view d, std::string_view css_class) {
  body_ += fmt::format(R"(<path class="{}" d="{}"/>)", css_class, d);
}

void Svg::text(double x, double y, std::string_view anchor, std::string_view css_class,
               std::string_view text) {
  body_ += fmt::format(R"(<text class="{}" x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)",
                       css_class, x, y, anchor, escaped(text));
}

void Svg::upward_text(double x, double y, std::string_view css_class, std::string_view text) {
  body_ +=
      fmt::format(R"(<text class="{}" text-anchor="middle" transform="translate({:.1f} {:.1f}) )"
                  "rotate(-90)\">{}</text>",
                  css_class, x, y, escaped(text));
}

void Svg::triangle(double x, double y, double r, std::string_view css_class) {
  path(fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z", x, y - 1.1 * r, r, 1.8 * r, -2.0 * r),
       css_class);
}

void Svg::square(double x, double y, double r, std::string_view css_class) {
  rect(x - 0.85 * r, y - 0.85 * r, 1.7 * r, 1.7 * r, css_class);
}

void Svg::diamond(double x, double y, double r, std::string_view css_class) {
  path(fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}z", x, y - r, r, r, -r,
                   r, -r, -r),
       css_class);
}

void Svg::cross(double x, double y, double r, std::string_view css_class) {
  path(fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}m0 {:.1f}l{:.1f} {:.1f}", x - r, y - r, 2.0 * r,
                   2.0 * r, -2.0 * r, -2.0 * r, 2.0 * r),
       css_class);
}

double Scale::at(double value) const {
  const double part =
      decades ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return from + part * (to - from);
}

std::string tick_label(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return fmt::format("{:.6g}", value);
}

std::string diverging_colour(double ratio) {
  static constexpr std::array<Rgb, 7> kStops = {{{8, 69, 130},
                                                 {62, 139, 196},
                                                 {163, 204, 230},
                                                 {250, 250, 248},
                                                 {250, 200, 148},
                                                 {226, 132, 52},
                                                 {152, 70, 8}}};
  return between(kStops, 0.5 * (ratio + 1.0));
}

std::string sequential_colour(double ratio) {
  static constexpr std::array<Rgb, 4> kStops = {
      {{8, 58, 110}, {46, 124, 184}, {150, 196, 226}, {226, 236, 244}}};
  return between(kStops, ratio);
}

}  // namespace rondure::reports
