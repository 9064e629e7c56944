#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/wheel/result.h"
#include "reports/escaping.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/internal/plot_wheel.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;
using core::signed_um;
using core::um;

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
                                : trf("{} mean of {} quadruples", tr(fit::name_of(m.mean)),
                                      m.centers.accepted.size()),
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
    return entry(tr("Radial run-out"), with_note("≥ " + fim, in_sentence(bound)));
  }
  return entry(
      tr("Radial run-out"),
      with_note(fim, trf("eccentricity {} µm; effective radius {} mm",
                         um(m.runout->eccentricity_mm), fixed(m.runout->effective_radius_mm, 6))));
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
  return fmt::format(
      R"(<p class="note">{}</p>)",
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
  return R"(<div class="scroll">)" +
         line_chart(tr("Wheel radius over concave radius of curvature"), "x / mm", "R k_s",
                    {load, line}) +
         "</div>";
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
    html += fmt::format(
        R"(<p class="note">{}</p>)",
        trf("The path is for the mean radius: the farthest point from the axis cuts {} µm deeper.",
            (e.wheel.runout->bound_because.empty() ? "" : "≥ ") +
                um(e.wheel.runout->effective_radius_mm - e.wheel.radius_mm)));
  }
  html += wheel_path_plot(*e.path) + load_chart(*e.path, facts.task.path->options.load_limit);
  return html + forecast_part(*e.forecast);
}

}  // namespace

std::string wheel_part(const evaluation::WheelResult& facts) {
  const fit::WheelMeasurement& m = facts.evaluation.wheel;
  return R"(<dl class="keys">)" + radius_entries(facts) + runout_entry(m) + center_entries(m) +
         fmt::format(R"(</dl><h3>{}</h3><div class="multiples single">)", tr("Edge of the wheel")) +
         wheel_edge_plot(m, facts.points_mm) + "</div>" + path_part(facts);
}

}  // namespace rondure::reports
