#include "app/text/wheel.h"

#include <cmath>

#include <fmt/format.h>

#include "app/text/answer.h"
#include "core/units.h"

namespace rondure::app {
namespace {

std::string center_words(const fit::WheelMeasurement& m) {
  if (m.mean == fit::WheelMean::kLeastSquares) return "least squares";
  return fmt::format("{} of {} quadruples",
                     m.mean == fit::WheelMean::kWeighted ? "weighted mean" : "mean",
                     m.centers.accepted.size());
}

/// The other centre, that of the quadruples or that of least squares.
std::string check_words(const fit::WheelMeasurement& m) {
  if (m.mean == fit::WheelMean::kLeastSquares) {
    return fmt::format("weighted mean of {} quadruples ({:.6f}, {:.6f}) mm",
                       m.centers.accepted.size(), m.quadruple_center_mm.x(),
                       m.quadruple_center_mm.y());
  }
  return fmt::format("geometric least squares ({:.6f}, {:.6f}) mm, R {:.6f} mm, PV {:.3f} um",
                     m.check.center_mm.x(), m.check.center_mm.y(), m.check.radius_mm,
                     core::micrometres(m.check.deviation_mm));
}

std::string circle_lines(const fit::WheelMeasurement& m) {
  std::string out = fmt::format(
      "wheel, {} points, {} mode\n"
      "  centre    ({:.6f}, {:.6f}) mm, u {:.3f} um, {}\n"
      "  radius    R {:.6f} mm, u(R) {:.3f} um\n"
      "  spread    s_r {:.3f} um, PV {:.3f} um about the centre",
      m.points, name_of(m.mode), m.center_mm.x(), m.center_mm.y(),
      core::micrometres(m.center_uncertainty_mm), center_words(m), m.radius_mm,
      core::micrometres(m.radius_uncertainty_mm), core::micrometres(m.spread_mm),
      core::micrometres(m.deviation_mm));
  if (m.zone) out += fmt::format(", minimum zone {:.3f} um", core::micrometres(m.zone->width_mm()));
  out += fmt::format(
      "\n  arc       {:.1f} deg covered; a point error shows {:.2f} times in the centre, {:.2f} in "
      "R; tau {:.2f}\n",
      core::degrees(m.order.coverage_rad()), m.factors.center, m.factors.radius, m.correlation);
  return out;
}

std::string center_lines(const fit::WheelMeasurement& m) {
  const fit::WheelCenters& c = m.centers;
  return fmt::format(
      "  centres   scatter {:.3f} um (noise alone {:.3f} um), farthest {:.3f} um; kappa {:.3f} to "
      "{:.3f}\n"
      "  refused   {} for a short chord, {} for parallel chords, {} for kappa{}\n"
      "  check     {}\n",
      core::micrometres(m.center_scatter_mm), core::micrometres(m.expected_scatter_mm),
      core::micrometres(m.farthest_center_mm), c.best_kappa(), c.worst_kappa(), c.short_chord,
      c.parallel_chords, c.ill_conditioned,
      std::isfinite(c.kappa_limit) ? fmt::format(" above {:.3g}", c.kappa_limit) : "",
      check_words(m));
}

std::string runout_line(const fit::WheelMeasurement& m) {
  if (!m.runout) return fmt::format("  run-out   not stated: {}\n", m.runout_absent.english());
  const std::string bound = m.runout->bound_because;
  const std::string_view at_least = bound.empty() ? "" : "at least ";
  const std::string out = fmt::format(
      "  run-out   FIM {}{:.3f} um about the axis ({:.6f}, {:.6f}) mm; eccentricity {:.3f} um; "
      "effective radius {}{:.6f} mm\n",
      at_least, core::micrometres(m.runout->fim_mm), m.runout->axis_mm.x(), m.runout->axis_mm.y(),
      core::micrometres(m.runout->eccentricity_mm), at_least, m.runout->effective_radius_mm);
  return bound.empty() ? out : out + fmt::format("            a bound: {}\n", bound);
}

std::string path_lines(const fit::WheelEvaluation& e) {
  const fit::WheelPath& path = *e.path;
  std::string out = fmt::format(
      "  path      {} places for the {} radius {:.6f} mm, step {:.6g} mm, cusps up to {:.3f} um, z "
      "of the wheel's {}\n"
      "            R k_s at most {:.4f}, at x = {:.4g} mm",
      path.rows.size(), name_of(e.radius), path.radius_mm, path.step_mm,
      core::micrometres(path.cusp_mm), path.lowest_point ? "lowest point" : "centre",
      path.load.load, std::round(path.load.x_mm * 1e4) / 1e4 + 0.0);
  if (path.load.load > 0.0) {
    out += fmt::format(" (concave radius {:.4f} mm)", path.load.concave_radius_mm(path.radius_mm));
  }
  return out + "\n";
}

/// What run-out does to a path for the mean radius.
std::string overcut_line(const fit::WheelEvaluation& e) {
  if (e.radius != fit::RadiusChoice::kMean || !e.wheel.runout) return {};
  return fmt::format(
      "  overcut   {}{:.3f} um: the highest point cuts deeper than the mean radius; --radius "
      "effective "
      "takes it into account\n",
      e.wheel.runout->bound_because.empty() ? "" : "at least ",
      core::micrometres(e.wheel.runout->effective_radius_mm - e.wheel.radius_mm));
}

std::string forecast_lines(const fit::WheelForecast& f) {
  std::string out;
  if (f.nominal) {
    out += fmt::format(
        "  residual  without compensation: {:+.3f} um along the normal, PV {:.3f} um after "
        "touch-off at x = {} mm\n",
        core::micrometres(f.nominal->delta_mm), core::micrometres(f.nominal->deviation_mm),
        f.nominal->touch_off_mm);
  }
  out += fmt::format("  residual  with compensation: within {:.3f} um (2 u(R)), PV {:.4f} um\n",
                     core::micrometres(f.measured.delta_mm),
                     core::micrometres(f.measured.deviation_mm));
  if (f.improvement) {
    out += fmt::format("            improvement {:.1f} times{}\n", *f.improvement,
                       f.capped ? ", limited by the machine's repeatability" : "");
  }
  return out;
}

}  // namespace

std::string wheel_table(const fit::WheelEvaluation& evaluation, const fit::WheelTask& task) {
  const fit::WheelMeasurement& m = evaluation.wheel;
  std::string out = circle_lines(m) + center_lines(m) + runout_line(m);
  if (task.wheel.robust) {
    out += fmt::format("  robust    {} points dropped, scale {:.3f} um\n", m.dropped.size(),
                       core::micrometres(m.outlier_scale_mm));
  }
  if (evaluation.path) out += path_lines(evaluation) + overcut_line(evaluation);
  if (evaluation.forecast) out += forecast_lines(*evaluation.forecast);
  out += warnings_text(m.warnings);
  if (evaluation.path) out += warnings_text(evaluation.path->warnings);
  return out;
}

}  // namespace rondure::app
