#include "reports/drawings/internal/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "reports/escaping.h"

namespace rondure::reports {
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
