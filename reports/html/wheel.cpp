#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/wheel/result.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/sections.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;
using core::signed_um;
using core::um;

constexpr double kEdgeSize = 340.0;
constexpr double kEdgeCentre = 170.0;
constexpr double kEdgeMean = 104.0;  ///< Radius of the mean circle as drawn.
constexpr double kEdgeReach = 24.0;  ///< Largest deviation of a used point as drawn.
constexpr double kMiddle = 64.0;     ///< Greatest radius of the drawing in the centre.
constexpr std::size_t kMostCenters = 250;

struct EdgeView {
  const fit::WheelMeasurement& wheel;
  double px_per_mm = 1.0;

  [[nodiscard]] double radius(double deviation_mm) const {
    return kEdgeMean + std::clamp(px_per_mm * deviation_mm, -1.3 * kEdgeReach, 1.3 * kEdgeReach);
  }
  [[nodiscard]] Eigen::Vector2d at(double angle_rad, double r) const {
    return {kEdgeCentre + r * std::cos(angle_rad), kEdgeCentre - r * std::sin(angle_rad)};
  }
  /// A place near the wheel's centre, at the same magnification; at most `kMiddle` from it.
  [[nodiscard]] Eigen::Vector2d middle(const Eigen::Vector2d& p) const {
    Eigen::Vector2d off = px_per_mm * (p - wheel.center_mm);
    if (off.norm() > kMiddle) off *= kMiddle / off.norm();
    return {kEdgeCentre + off.x(), kEdgeCentre - off.y()};
  }
};

EdgeView edge_view(const fit::WheelMeasurement& wheel) {
  double largest = 1e-6;
  for (const std::size_t row : wheel.order.rows) {
    largest = std::max(largest, std::abs(wheel.deviations_mm[row]));
  }
  return {wheel, kEdgeReach / largest};
}

void draw_angles(Svg& svg, const EdgeView& view) {
  constexpr std::array<const char*, 4> kNames = {"0°", "90°", "180°", "270°"};
  for (int tick = 0; tick < 12; ++tick) {
    const double angle = tick * 30.0 * core::kDegree;
    const double from = kEdgeMean + 1.3 * kEdgeReach + 3.0;
    const Eigen::Vector2d a = view.at(angle, from);
    const Eigen::Vector2d b = view.at(angle, from + (tick % 3 == 0 ? 7.0 : 4.0));
    svg.line(a.x(), a.y(), b.x(), b.y(), "tick");
    if (tick % 3 != 0) continue;
    const Eigen::Vector2d place = view.at(angle, from + 20.0);
    svg.text(place.x(), place.y() + 4.0, "middle", "label",
             kNames[static_cast<std::size_t>(tick / 3)]);
  }
}

void draw_edge(Svg& svg, const EdgeView& view) {
  const auto& deviations = view.wheel.deviations_mm;
  const auto& order = view.wheel.order;
  double low = 0.0;
  double high = 0.0;
  std::string guide;
  for (std::size_t k = 0; k < order.rows.size(); ++k) {
    const double deviation = deviations[order.rows[k]];
    low = std::min(low, deviation);
    high = std::max(high, deviation);
    const Eigen::Vector2d p = view.at(order.angles_rad[k], view.radius(deviation));
    guide += fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', p.x(), p.y());
  }
  svg.circle(kEdgeCentre, kEdgeCentre, view.radius(high), "zone-outer");
  svg.circle(kEdgeCentre, kEdgeCentre, view.radius(low), "zone-inner");
  svg.circle(kEdgeCentre, kEdgeCentre, kEdgeMean, "mean");
  svg.path(order.closed() ? guide + "z" : guide, "guide");
}

void draw_points(Svg& svg, const EdgeView& view, std::span<const Eigen::Vector2d> dropped_at) {
  const auto& order = view.wheel.order;
  const double size = order.rows.size() <= 60 ? 3.2 : 1.8;
  for (std::size_t k = 0; k < order.rows.size(); ++k) {
    const double deviation = view.wheel.deviations_mm[order.rows[k]];
    const Eigen::Vector2d p = view.at(order.angles_rad[k], view.radius(deviation));
    svg.circle(p.x(), p.y(), size, "point");
  }
  for (std::size_t i = 0; i < dropped_at.size(); ++i) {
    const Eigen::Vector2d v = dropped_at[i] - view.wheel.center_mm;
    const double deviation = view.wheel.deviations_mm[view.wheel.dropped[i].row];
    const Eigen::Vector2d p = view.at(std::atan2(v.y(), v.x()), view.radius(deviation));
    svg.cross(p.x(), p.y(), 5.0, "no-value");
  }
}

void draw_middle(Svg& svg, const EdgeView& view) {
  const auto& centers = view.wheel.centers.accepted;
  const std::size_t shown = std::min(centers.size(), kMostCenters);
  for (std::size_t i = 0; i < shown; ++i) {
    const Eigen::Vector2d p = view.middle(centers[i * centers.size() / shown].center_mm);
    svg.circle(p.x(), p.y(), 1.4, "trail");
  }
  svg.cross(kEdgeCentre, kEdgeCentre, 6.0, "scale");
  if (!view.wheel.runout) return;
  const Eigen::Vector2d axis = view.middle(view.wheel.runout->axis_mm);
  svg.diamond(axis.x(), axis.y(), 6.0, "final");
}

void draw_scale_bar(Svg& svg, const EdgeView& view) {
  const double length_um = core::round_below(36.0 / view.px_per_mm / core::kMicrometre);
  const double length = length_um * core::kMicrometre * view.px_per_mm;
  scale_bar(svg, 323, length, length_um);
}

struct SideView {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
  double px_per_mm = 1.0;
  double left = 64.0;
  double bottom = 0.0;

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& p) const {
    return {left + px_per_mm * (p.x() - low.x()), bottom - px_per_mm * (p.y() - low.y())};
  }
};

constexpr double kViewWidth = 700.0;
constexpr double kMostViewHeight = 380.0;
constexpr double kViewTop = 12.0;
constexpr double kRightMargin = 16.0;

SideView side_view(const fit::WheelPath& path) {
  SideView view;
  view.low = path.rows.front().center_mm;
  view.high = view.low;
  const auto take = [&](const Eigen::Vector2d& p) {
    view.low = view.low.cwiseMin(p);
    view.high = view.high.cwiseMax(p);
  };
  const Eigen::Vector2d reach(path.radius_mm, path.radius_mm);
  for (const fit::WheelPathRow& row : path.rows) {
    take(row.center_mm - reach);
    take(row.center_mm + reach);
    take({row.x_mm, row.surface.height_mm});
  }
  const Eigen::Vector2d air = 0.03 * (view.high - view.low);
  view.low -= air;
  view.high += air;
  const Eigen::Vector2d size = view.high - view.low;
  view.px_per_mm =
      std::min((kViewWidth - view.left - kRightMargin) / size.x(), kMostViewHeight / size.y());
  // Centres a tall view, which is narrower than the page.
  view.left = std::max(view.left, 0.5 * (kViewWidth - view.px_per_mm * size.x()));
  view.bottom = kViewTop + view.px_per_mm * size.y();
  return view;
}

void draw_axes(Svg& svg, const SideView& view) {
  const Eigen::Vector2d corner = view.at(view.high);
  for (const double x : core::round_ticks(view.low.x(), view.high.x(), 8)) {
    const double px = view.at({x, view.low.y()}).x();
    svg.line(px, kViewTop, px, view.bottom, "grid");
    tick_below(svg, px, view.bottom, tick_label(x));
  }
  for (const double z : core::round_ticks(view.low.y(), view.high.y(), 6)) {
    const double py = view.at({view.low.x(), z}).y();
    svg.line(view.left, py, corner.x(), py, "grid");
    label_beside(svg, view.left, py, tick_label(z), 7.0);
  }
  svg.rect(view.left, kViewTop, corner.x() - view.left, view.bottom - kViewTop, "frame");
  svg.text(0.5 * (view.left + corner.x()), view.bottom + 36.0, "middle", "title", "x / mm");
  svg.upward_text(view.left - 50.0, 0.5 * (kViewTop + view.bottom), "title", "z / mm");
}

/// A line through the places of all rows, thinned to some 700.
template <class Place>
std::string line_of(const fit::WheelPath& path, const SideView& view, const Place& place) {
  const std::size_t step = std::max<std::size_t>(1, path.rows.size() / 700);
  std::string d;
  for (std::size_t i = 0; i < path.rows.size(); i += step) {
    const Eigen::Vector2d p = view.at(place(path.rows[i]));
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? 'M' : 'L', p.x(), p.y());
  }
  const Eigen::Vector2d last = view.at(place(path.rows.back()));
  return d + fmt::format("L{:.1f} {:.1f}", last.x(), last.y());
}

void draw_wheel(Svg& svg, const SideView& view, const fit::WheelPathRow& row, double radius_mm) {
  const Eigen::Vector2d c = view.at(row.center_mm);
  const Eigen::Vector2d contact = view.at({row.x_mm, row.surface.height_mm});
  svg.circle(c.x(), c.y(), view.px_per_mm * radius_mm, "mean");
  svg.line(c.x(), c.y(), contact.x(), contact.y(), "guide");
  svg.circle(contact.x(), contact.y(), 3.0, "point");
}

/// The edge of a wheel: deviations of its points about the mean circle, magnified; in its centre,
/// at the same magnification, the centres of the quadruples and the spindle axis.
std::string wheel_edge_plot(const fit::WheelMeasurement& wheel,
                            std::span<const Eigen::Vector2d> points_mm) {
  const EdgeView view = edge_view(wheel);
  Svg svg(kEdgeSize, kEdgeSize, "polar", tr("Edge of the wheel: deviations about the mean circle"));
  draw_angles(svg, view);
  draw_edge(svg, view);
  draw_middle(svg, view);
  std::vector<Eigen::Vector2d> dropped;
  for (const fit::DroppedPoint& point : wheel.dropped) dropped.push_back(points_mm[point.row]);
  draw_points(svg, view, dropped);
  draw_scale_bar(svg, view);
  return fmt::format(
      "<figure>{}<figcaption>{}</figcaption></figure>", svg.str(),
      trf("Deviations about the mean circle, magnified {}×; the line guides the eye only. Orange "
          "and blue: farthest and nearest point. In the middle, magnified alike: centres of the "
          "quadruples (grey), the centre (cross){}{}.",
          fixed(view.px_per_mm * wheel.radius_mm / kEdgeMean, 0),
          wheel.runout ? tr(", the spindle axis (orange; drawn at the edge when farther off)")
                       : std::string(),
          wheel.dropped.empty() ? std::string() : tr("; crosses on the edge: dropped points")));
}

/// Side view of a path, x and z at one scale: the surface, the path of the wheel's centre, the
/// wheel at both ends and halfway.
std::string wheel_path_plot(const fit::WheelPath& path) {
  const SideView view = side_view(path);
  Svg svg(kViewWidth, view.bottom + 46.0, "wide", tr("Surface, wheel and the way of its centre"));
  draw_axes(svg, view);
  const std::string surface = line_of(path, view, [](const fit::WheelPathRow& row) {
    return Eigen::Vector2d(row.x_mm, row.surface.height_mm);
  });
  const double right = view.at({path.rows.back().x_mm, 0.0}).x();
  const double left = view.at({path.rows.front().x_mm, 0.0}).x();
  svg.path(
      surface + fmt::format("L{:.1f} {:.1f}L{:.1f} {:.1f}z", right, view.bottom, left, view.bottom),
      "band");
  svg.path(surface, "profile");
  for (const std::size_t row : {std::size_t{0}, path.rows.size() / 2, path.rows.size() - 1}) {
    draw_wheel(svg, view, path.rows[row], path.radius_mm);
  }
  svg.path(line_of(path, view, [](const fit::WheelPathRow& row) { return row.center_mm; }),
           "zone-inner");
  return fmt::format(
      R"(<figure><div class="scroll">{}</div><figcaption>{}</figcaption></figure>)", svg.str(),
      tr("x and z at one scale. Black: the surface, material shaded; blue: way of the wheel's "
         "centre; dashed: the wheel at both ends and half way, with the line to its contact."));
}

std::string radius_entries(const evaluation::WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  std::string nominal;
  if (const auto& r = facts.task.wheel.nominal_radius_mm) {
    nominal = trf(", {} µm from nominal {} mm", signed_um(m.radius_mm - *r), fixed(*r, 3));
  }
  std::string html =
      entry(tr("Radius R"),
            with_note(fixed(m.radius_mm, 5) + " mm",
                      fmt::format("u(R) {} µm{}", um(m.radius_uncertainty_mm), nominal)),
            "lead");
  html += entry(
      tr("Centre (x, z)"),
      with_note(fmt::format("{}, {} mm", fixed(m.center_mm.x(), 6), fixed(m.center_mm.y(), 6)),
                fmt::format("{}, u {} µm",
                            m.mean == fit::WheelMean::kLeastSquares
                                ? tr("least squares")
                                : trf("mean of {} quadruples", m.centers.accepted.size()),
                            um(m.center_uncertainty_mm))));
  html += entry(
      tr("Distances"),
      with_note(fmt::format("PV {} µm", um(m.deviation_mm)),
                trf("s_r {} µm about the centre{}", um(m.spread_mm),
                    m.zone ? trf("; minimum zone {} µm", um(m.zone->width_mm())) : std::string())));
  return html;
}

std::string runout_entry(const fit::WheelMeasurement& m) {
  if (!m.runout) {
    return entry(tr("Radial run-out"), with_note(tr("not stated"), plain_words(m.runout_absent)));
  }
  const std::string fim = um(m.runout->fim_mm) + " µm";
  if (const core::Phrase& bound = m.runout->bound_because; !bound.empty()) {
    return entry(tr("Radial run-out"),
                 with_note("≥ " + fim, trf("as read; {}", in_sentence(bound))));
  }
  return entry(
      tr("Radial run-out"),
      with_note(fim, trf("eccentricity {} µm; effective radius {} mm",
                         um(m.runout->eccentricity_mm), fixed(m.runout->effective_radius_mm, 6))));
}

/// Empty without a run-out, whose entry then says why.
std::string effective_radius_entry(const evaluation::WheelResult& facts) {
  if (!facts.evaluation.wheel.runout) return {};
  const core::Phrase stated = effective_radius_in_words(facts);
  return stated.empty() ? std::string()
                        : entry(tr("Effective radius"), in_sentence(stated), "wide-key");
}

std::string center_entries(const fit::WheelMeasurement& m) {
  const fit::WheelCenters& c = m.centers;
  std::string html =
      entry(tr("Points"),
            with_note(trf("{} of {} used, {} mode", m.points - m.dropped.size(), m.points,
                          tr(fit::name_of(m.mode))),
                      trf("{}° of the circle; a point error shows {} times in the centre, {} in R",
                          deg(m.order.coverage_rad(), 1), fixed(m.factors.center, 2),
                          fixed(m.factors.radius, 2))));
  html += entry(tr("Scatter of the centres"),
                with_note(um(m.center_scatter_mm) + " µm",
                          trf("noise alone {} µm; kappa {} to {}", um(m.expected_scatter_mm),
                              fixed(c.best_kappa(), 2), fixed(c.worst_kappa(), 2))));
  html += entry(tr("Quadruples refused"), trf("{} short chords, {} parallel, {} ill-conditioned",
                                              c.short_chord, c.parallel_chords, c.ill_conditioned));
  const double apart = (m.quadruple_center_mm - m.check.center_mm).norm();
  if (m.mean == fit::WheelMean::kLeastSquares) {
    return html + entry(tr("Check: mean of the quadruples"), trf("centre {} µm apart", um(apart)));
  }
  return html + entry(tr("Check: least squares"),
                      with_note(fmt::format("R {} mm", fixed(m.check.radius_mm, 6)),
                                trf("centre {} µm apart", um(apart))));
}

std::string path_text(const fit::WheelPath& path, fit::RadiusChoice choice) {
  std::string hollow = tr("The surface is nowhere hollow.");
  if (path.load.load > 0.0) {
    hollow =
        trf("R k<sub>s</sub> reaches {} at x = {} mm, where the concave radius is {} "
            "mm; at 1 the wheel would gouge.",
            fixed(path.load.load, 4), fixed(path.load.x_mm, 3),
            fixed(path.load.concave_radius_mm(path.radius_mm), 3));
  }
  return note(
      trf("{} places for the {} radius {} mm, {} mm apart in x; cusps up to {} µm between passes. "
          "{} The wheel was looked for inside the surface at every place: nowhere.",
          path.rows.size(), tr(fit::name_of(choice)), fixed(path.radius_mm, 6),
          fixed(path.step_mm, 4), um(path.cusp_mm), hollow));
}

Curve residual_curve(const fit::ResidualForm& form, std::string name, std::string css_class) {
  Curve out{std::move(name), std::move(css_class), {}, {}};
  for (const fit::ResidualRow& row : form.rows) {
    out.x.push_back(row.x_mm);
    out.y.push_back(row.touched_mm / core::kMicrometre);
  }
  return out;
}

std::string forecast_part(const fit::WheelForecast& f) {
  std::vector<Curve> curves;
  std::string text;
  if (f.nominal) {
    curves.push_back(residual_curve(*f.nominal, tr("path for the nominal radius"), "zone-outer"));
    text =
        trf("Without compensation {} µm are wrong along the normal, and {} µm of form "
            "remain after touch-off. ",
            signed_um(f.nominal->delta_mm), um(f.nominal->deviation_mm));
  }
  curves.push_back(
      residual_curve(f.measured, tr("path for the measured radius, 2 u(R) off"), "zone-inner"));
  text += trf("With compensation the error is within {} µm (2 u(R)), its form within {} µm.",
              um(f.measured.delta_mm), um(f.measured.deviation_mm));
  if (f.improvement) {
    text += trf(" Improvement: {} times{}.", fixed(*f.improvement, 1),
                f.capped ? tr(", limited by the machine's repeatability") : std::string());
  }
  text +=
      trf(" Touch-off at x = {} mm; above 0: material left on.", fixed(f.measured.touch_off_mm, 3));
  return fmt::format(
      R"(<h3>{}</h3><p class="note">{}</p><div class="scroll">{}</div>)", tr("Residual form"), text,
      line_chart(tr("Form left after touch-off"), "x / mm", tr("error / µm"), curves));
}

std::string load_chart(const fit::WheelPath& path, double limit) {
  Curve load{"R k_s", "profile", {}, {}};
  for (const fit::WheelPathRow& row : path.rows) {
    load.x.push_back(row.x_mm);
    load.y.push_back(row.load);
  }
  Curve line{tr("limit"), "zone-outer", {load.x.front(), load.x.back()}, {limit, limit}};
  return scrolling(line_chart(tr("Wheel radius over concave radius of curvature"), "x / mm",
                              "R k_s", {load, line}));
}

std::string path_part(const evaluation::WheelResult& facts) {
  const fit::WheelEvaluation& e = facts.evaluation;
  if (!facts.task.path) return {};
  std::string html = fmt::format("<h3>{}</h3>", tr("Way of the wheel's centre"));
  if (e.refused) {
    return html + fmt::format(R"(<p class="banner alarm"><b>{}</b> {}{}</p>)", tr("No path:"),
                              titled(e.refused->code), trf("{}.", in_sentence(e.refused->said())));
  }
  html += path_text(*e.path, e.radius);
  if (e.radius == fit::RadiusChoice::kMean && e.wheel.runout) {
    html += note(
        trf("The path is for the mean radius: the farthest point from the axis cuts {} µm deeper.",
            (e.wheel.runout->bound_because.empty() ? "" : "≥ ") +
                um(e.wheel.runout->effective_radius_mm - e.wheel.radius_mm)));
  }
  html += wheel_path_plot(*e.path) + load_chart(*e.path, facts.task.path->options.load_limit);
  return html + forecast_part(*e.forecast);
}

std::string words_of_wheel() {
  return explained(
             tr("Radial run-out"),
             tr("Greatest minus least distance of the edge from the spindle axis: eccentricity "
                "and form together.")) +
         explained(tr("Effective radius"),
                   tr("Greatest distance of the edge from the spindle axis: what cuts deepest.")) +
         explained("R, u(R)",
                   tr("Mean distance of the points from the centre of the edge, and its standard "
                      "uncertainty: from the declared errors of point, scale, threshold and wear; "
                      "where those of a point are not declared, from the scatter of the points "
                      "alone.")) +
         explained("kappa",
                   tr("Factor by which the centre of one quadruple of points amplifies the "
                      "error of a point."));
}

}  // namespace

std::string analysis_part(const evaluation::WheelResult& facts, const record::RunRecord& /*record*/,
                          int /*feature*/) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  return fmt::format(R"(<h3>{}</h3><div class="multiples single">)", tr("Edge of the wheel")) +
         wheel_edge_plot(m, facts.points_mm) + "</div>" + as_read_note() + R"(<dl class="keys">)" +
         radius_entries(facts) + runout_entry(m) + effective_radius_entry(facts) +
         center_entries(m) + "</dl>" + words_of_wheel() + path_part(facts);
}

}  // namespace rondure::reports
