#include "reports/html/internal/plot_curve.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"

namespace rondure::reports {
namespace {

constexpr std::size_t kMostPoints = 1440;
constexpr double kPolarSize = 320.0;
constexpr double kPolarCentre = 160.0;
constexpr double kMeanCircle = 84.0;
constexpr double kPolarReach = 34.0;  ///< Largest deviation as drawn.
constexpr double kChartWidth = 720.0;
constexpr double kChartHeight = 260.0;
constexpr double kChartLeft = 64.0;
constexpr double kChartRight = 16.0;
constexpr double kChartTop = 12.0;
constexpr double kChartBottom = 44.0;

/// At most kMostPoints indices: for each piece those of its least and greatest value, in order.
std::vector<std::size_t> drawn_points(const std::vector<double>& values) {
  std::vector<std::size_t> out;
  const std::size_t count = values.size();
  const std::size_t pieces = count <= kMostPoints ? count : kMostPoints / 2;
  for (std::size_t p = 0; p < pieces; ++p) {
    const std::size_t from = p * count / pieces;
    const std::size_t to = (p + 1) * count / pieces;
    std::size_t low = from;
    std::size_t high = from;
    for (std::size_t i = from; i < to; ++i) {
      if (values[i] < values[low]) low = i;
      if (values[i] > values[high]) high = i;
    }
    out.push_back(std::min(low, high));
    if (low != high) out.push_back(std::max(low, high));
  }
  return out;
}

/// Names of the lines under a drawing, each with a sample of the line.
std::string legend_of(const std::vector<Curve>& curves) {
  std::string out;
  for (const Curve& curve : curves) {
    if (curve.name.empty()) continue;
    out += fmt::format(
        R"({}<svg class="key" aria-hidden="true" viewBox="0 0 22 8" width="22" height="8"><path class="{}" )"
        R"(d="{}"/></svg> {})",
        out.empty() ? "" : " · ", curve.css_class,
        curve.marks_only ? "M13.6 4a2.6 2.6 0 1 0-5.2 0a2.6 2.6 0 1 0 5.2 0" : "M1 4h20",
        escaped(curve.name));
  }
  return out;
}

std::string figure(const Svg& svg, std::string_view title, const std::vector<Curve>& curves) {
  const std::string legend = legend_of(curves);
  return fmt::format("<figure>{}<figcaption><b>{}</b>{}{}</figcaption></figure>", svg.str(),
                     escaped(std::string(title)), legend.empty() ? "" : " · ", legend);
}

double largest(const std::vector<Curve>& curves) {
  double out = 0.0;
  for (const Curve& curve : curves) {
    for (const double y : curve.y) out = std::max(out, std::abs(y));
  }
  return out;
}

std::string polar_path(const Curve& curve, double px_per_um, bool closed) {
  std::string d;
  for (const std::size_t i : drawn_points(curve.y)) {
    const double r = kMeanCircle + px_per_um * curve.y[i];
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? 'M' : 'L',
                     kPolarCentre + r * std::cos(curve.x[i]),
                     kPolarCentre - r * std::sin(curve.x[i]));
  }
  return closed ? d + "z" : d;
}

void polar_frame(Svg& svg) {
  svg.circle(kPolarCentre, kPolarCentre, kMeanCircle, "mean");
  draw_polar_axes(svg, {kPolarCentre, kMeanCircle + kPolarReach + 6.0, 5.0, 5.0, 133.0, 134.0});
}

/// Axes of an ordinary chart, with a margin round the values.
struct ChartAxes {
  Scale x;
  Scale y;
};

ChartAxes axes_over(double x_low, double x_high, double y_low, double y_high) {
  if (!(x_high > x_low)) x_high = x_low + 1.0;
  const double room = y_high > y_low ? 0.06 * (y_high - y_low) : 1.0;
  return {{x_low, x_high, kChartLeft, kChartWidth - kChartRight},
          {y_low - room, y_high + room, kChartHeight - kChartBottom, kChartTop}};
}

void draw_axes(Svg& svg, const ChartAxes& axes, std::string_view x_title,
               std::string_view y_title) {
  for (const double tick : core::round_ticks(axes.y.low, axes.y.high, 5)) {
    const double y = axes.y.at(tick);
    svg.line(kChartLeft, y, kChartWidth - kChartRight, y, "grid");
    label_beside(svg, kChartLeft, y, tick_label(tick), 6.0);
  }
  for (const double tick : core::round_ticks(axes.x.low, axes.x.high, 8)) {
    tick_below(svg, axes.x.at(tick), kChartHeight - kChartBottom, tick_label(tick));
  }
  svg.rect(kChartLeft, kChartTop, kChartWidth - kChartRight - kChartLeft,
           kChartHeight - kChartBottom - kChartTop, "frame", "none");
  svg.text(0.5 * (kChartLeft + kChartWidth - kChartRight), kChartHeight - 8.0, "middle", "title",
           x_title);
  svg.upward_text(14.0, 0.5 * (kChartTop + kChartHeight - kChartBottom), "title", y_title);
}

/// The band of a curve, as one closed shape: along its upper edge and back along the lower.
void draw_band(Svg& svg, const ChartAxes& axes, const Curve& curve) {
  std::string d;
  const std::size_t n = curve.x.size();
  for (std::size_t k = 0; k < 2 * n; ++k) {
    const std::size_t i = k < n ? k : 2 * n - 1 - k;
    const double y = curve.y[i] + (k < n ? curve.band[i] : -curve.band[i]);
    d += fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', axes.x.at(curve.x[i]), axes.y.at(y));
  }
  svg.path(d + "Z", "uncertainty");
}

}  // namespace

std::string polar_chart(std::string_view title, const std::vector<Curve>& curves, bool closed) {
  Svg svg(kPolarSize, kPolarSize, "polar", std::string(title));
  polar_frame(svg);
  const double px_per_um = kPolarReach / std::max(largest(curves), 1e-9);
  for (const Curve& curve : curves) svg.path(polar_path(curve, px_per_um, closed), curve.css_class);
  const double bar_um = core::round_below(kPolarReach / px_per_um);
  scale_bar(svg, 303, bar_um * px_per_um, bar_um);
  return figure(svg, title, curves);
}

std::string line_chart(std::string_view title, std::string_view x_title, std::string_view y_title,
                       const std::vector<Curve>& curves, double y_reach) {
  double x_low = 0.0;
  double x_high = 0.0;
  double y_low = 0.0;
  double y_high = 0.0;
  bool any = false;
  for (const Curve& curve : curves) {
    if (curve.x.empty()) continue;
    const auto [x0, x1] = std::minmax_element(curve.x.begin(), curve.x.end());
    const double band =
        curve.band.empty() ? 0.0 : *std::max_element(curve.band.begin(), curve.band.end());
    const auto [y0, y1] = std::minmax_element(curve.y.begin(), curve.y.end());
    x_low = any ? std::min(x_low, *x0) : *x0;
    x_high = any ? std::max(x_high, *x1) : *x1;
    y_low = any ? std::min(y_low, *y0 - band) : *y0 - band;
    y_high = any ? std::max(y_high, *y1 + band) : *y1 + band;
    any = true;
  }
  if (y_reach > 0.0) {
    y_low = std::min(y_low, -y_reach);
    y_high = std::max(y_high, y_reach);
  }
  const ChartAxes axes = axes_over(x_low, x_high, y_low, y_high);
  Svg svg(kChartWidth, kChartHeight, "wide", std::string(title));
  draw_axes(svg, axes, x_title, y_title);
  for (const Curve& curve : curves) {
    if (!curve.band.empty()) draw_band(svg, axes, curve);
  }
  for (const Curve& curve : curves) {
    if (curve.marks_only) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        svg.circle(axes.x.at(curve.x[i]), axes.y.at(curve.y[i]), 2.6, "profile", "#fff");
      }
      continue;
    }
    std::string d;
    for (const std::size_t i : drawn_points(curve.y)) {
      d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? 'M' : 'L', axes.x.at(curve.x[i]),
                       axes.y.at(curve.y[i]));
    }
    svg.path(d, curve.css_class);
  }
  return figure(svg, title, curves);
}

std::vector<BarLimit> limits_of(const std::vector<record::Characteristic>& asked) {
  std::vector<BarLimit> out;
  for (const record::Characteristic& characteristic : asked) {
    for (const record::HarmonicLimit& line : characteristic.harmonic_limits)
      out.push_back({line.first, line.last, line.amplitude_mm / core::kMicrometre});
  }
  return out;
}

std::string bar_chart(std::string_view title, std::string_view x_title, std::string_view y_title,
                      const std::vector<Bar>& bars, const std::vector<BarLimit>& limits) {
  if (bars.empty()) return {};
  double high = 0.0;
  for (const Bar& bar : bars) high = std::max(high, bar.value);
  for (const BarLimit& limit : limits) high = std::max(high, limit.value);
  ChartAxes axes = axes_over(bars.front().order - 0.5, bars.back().order + 0.5, 0.0, high);
  axes.y.low = 0.0;
  Svg svg(kChartWidth, kChartHeight, "wide", std::string(title));
  draw_axes(svg, axes, x_title, y_title);
  const double width = 0.7 * (axes.x.at(1.0) - axes.x.at(0.0));
  for (const Bar& bar : bars) {
    const double x = axes.x.at(bar.order);
    if (bar.hollow) {
      svg.cross(x, axes.y.at(0.0) - 7.0, 4.0, "no-value");
    } else {
      const double y = axes.y.at(bar.value);
      svg.rect(x - 0.5 * width, y, width, axes.y.at(0.0) - y, "point");
    }
  }
  for (const BarLimit& limit : limits) {
    const double y = axes.y.at(limit.value);
    svg.line(axes.x.at(std::max(limit.first - 0.5, axes.x.low)), y,
             axes.x.at(std::min(limit.last + 0.5, axes.x.high)), y, "zone-outer");
  }
  return figure(svg, title, {});
}

std::string span_chart(std::string_view title, std::string_view x_title, std::string_view y_title,
                       const std::vector<Span>& spans, const std::vector<double>& limits) {
  if (spans.empty()) return {};
  const auto [first, last] = std::ranges::minmax_element(spans, {}, &Span::x);
  double pitch = last->x - first->x;
  std::vector<double> places;
  for (const Span& span : spans) places.push_back(span.x);
  std::sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (places[i] > places[i - 1]) pitch = std::min(pitch, places[i] - places[i - 1]);
  }
  if (!(pitch > 0.0)) pitch = 1.0;
  double low = limits.empty() ? 0.0 : limits.front();
  double high = low;
  for (const double limit : limits) {
    low = std::min(low, limit);
    high = std::max(high, limit);
  }
  for (const Span& span : spans) {
    if (span.absent) continue;
    low = std::min(low, span.low);
    high = std::max(high, span.high);
  }
  ChartAxes axes = axes_over(first->x - 0.7 * pitch, last->x + 0.7 * pitch, low, high);
  if (low == 0.0) axes.y.low = 0.0;
  axes.y.high += 0.06 * (high - low);  // room for the mark above the worst bar
  Svg svg(kChartWidth, kChartHeight, "wide", std::string(title));
  draw_axes(svg, axes, x_title, y_title);
  const double width = std::clamp(0.6 * (axes.x.at(pitch) - axes.x.at(0.0)), 1.0, 28.0);
  for (const Span& span : spans) {
    const double x = axes.x.at(span.x);
    if (span.absent) {
      svg.cross(x, axes.y.at(axes.y.low) - 7.0, 4.0, "no-value");
      continue;
    }
    const double top = axes.y.at(span.high);
    svg.rect(x - 0.5 * width, top, width, std::max(axes.y.at(span.low) - top, 1.5),
             span.worst ? "span worst" : "span");
    if (span.worst) svg.diamond(x, top - 8.0, 4.5, "outer");
  }
  for (const double limit : limits) {
    svg.line(kChartLeft, axes.y.at(limit), kChartWidth - kChartRight, axes.y.at(limit),
             "span-limit");
  }
  return figure(svg, title, {});
}

}  // namespace rondure::reports
