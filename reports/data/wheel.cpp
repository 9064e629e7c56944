#include "reports/data/analyses.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "core/version.h"
#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

using core::micrometres;

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json point(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

Json quadruples(const fit::WheelMeasurement& m, const fit::QuadrupleOptions& options) {
  const fit::WheelCenters& c = m.centers;
  return {{"seed", options.seed},
          {"accepted", c.accepted.size()},
          {"refused",
           {{"short_chord", c.short_chord},
            {"parallel_chords", c.parallel_chords},
            {"ill_conditioned", c.ill_conditioned}}},
          {"kappa",
           {{"best", c.best_kappa()},
            {"rms", c.rms_kappa()},
            {"worst", c.worst_kappa()},
            {"limit", finite(c.kappa_limit)}}},
          {"center_mm", point(m.quadruple_center_mm)},
          {"scatter_um", micrometres(m.center_scatter_mm)},
          {"scatter_of_noise_um", micrometres(m.expected_scatter_mm)},
          {"farthest_um", micrometres(m.farthest_center_mm)}};
}

Json limits(const fit::WheelOptions& o) {
  return {{"least_chord_mm", o.quadruples.least_chord_mm},
          {"least_chord_per_radius", o.quadruples.least_chord_per_radius},
          {"least_angle_deg", in_deg(o.quadruples.least_angle_rad)},
          {"outlier_scales", o.outliers.scales},
          {"short_arc_allowed", o.allow_short_arc}};
}

Json runout(const fit::WheelMeasurement& m) {
  if (!m.runout) return nullptr;
  const fit::WheelRunout& found = *m.runout;
  Json out = {{"axis_mm", point(found.axis_mm)}};
  if (found.bound_because.empty()) {
    out["fim_um"] = micrometres(found.fim_mm);
  } else {
    out["fim_at_least_um"] = micrometres(found.fim_mm);
    out["effective_radius_at_least_mm"] = found.effective_radius_mm;
    out["bound_because"] = found.bound_because;
  }
  out["eccentricity_um"] = micrometres(found.eccentricity_mm);
  return out;
}

Json zone(const fit::WheelMeasurement& m) {
  if (!m.zone) return nullptr;
  return {{"center_mm", point(m.zone->center_mm)},
          {"deviation_um", micrometres(m.zone->width_mm())},
          {"certificate", fit::name_of(m.zone->certificate.kind)}};
}

Json path_curves(const fit::WheelPath& path) {
  using Row = fit::WheelPathRow;
  const auto of = [&](const auto& value) { return list_json(path.rows, value); };
  return {{"x_mm", of([](const Row& r) { return r.x_mm; })},
          {"f_mm", of([](const Row& r) { return r.surface.height_mm; })},
          {"slope", of([](const Row& r) { return r.surface.slope; })},
          {"xc_mm", of([](const Row& r) { return r.center_mm.x(); })},
          {"zc_mm", of([&](const Row& r) { return path.machine_z_mm(r); })},
          {"phi_deg", of([](const Row& r) { return in_deg(r.contact_rad); })},
          {"R_ks", of([](const Row& r) { return r.load; })},
          {"clearance_um", of([](const Row& r) { return micrometres(r.clearance_mm); })}};
}

Json residual_curves(const fit::ResidualForm& form) {
  using Row = fit::ResidualRow;
  const auto of = [&](const auto& value) { return list_json(form.rows, value); };
  return {{"x_mm", of([](const Row& r) { return r.x_mm; })},
          {"vertical_um", of([](const Row& r) { return micrometres(r.vertical_mm); })},
          {"touched_off_um", of([](const Row& r) { return micrometres(r.touched_mm); })}};
}

Json curves(const fit::WheelEvaluation& e) {
  Json out = {{"deviations_um", list_json(e.wheel.deviations_mm, micrometres)}};
  if (e.path) out["path"] = path_curves(*e.path);
  if (e.forecast) {
    out["residual_measured"] = residual_curves(e.forecast->measured);
    if (e.forecast->nominal) out["residual_nominal"] = residual_curves(*e.forecast->nominal);
  }
  return out;
}

Json path_json(const fit::WheelPath& path, const fit::WheelPathTask& task) {
  return {
      {"radius", fit::name_of(task.radius)},
      {"radius_mm", path.radius_mm},
      {"reference", path.lowest_point ? "lowest-point" : "center"},
      {"places", path.rows.size()},
      {"step_mm", path.step_mm},
      {"cusp_um", micrometres(path.cusp_mm)},
      {"greatest_R_ks",
       {{"value", path.load.load}, {"x_mm", path.load.x_mm}, {"limit", task.options.load_limit}}}};
}

Json residual(const fit::ResidualForm& form) {
  return {{"delta_um", micrometres(form.delta_mm)},
          {"touch_off_mm", form.touch_off_mm},
          {"deviation_um", micrometres(form.deviation_mm)}};
}

Json forecast(const fit::WheelForecast& f) {
  Json out = {{"nominal", f.nominal ? residual(*f.nominal) : Json(nullptr)},
              {"measured", residual(f.measured)}};
  out["improvement"] = optional_json(f.improvement);
  out["limited_by_machine"] = f.capped;
  return out;
}

Json warnings(const fit::WheelEvaluation& e) {
  Json out = Json::array();
  const auto add = [&](const core::Error& w) {
    out.push_back({{"code", core::code_name(w.code)}, {"what", w.what}});
  };
  for (const core::Error& w : e.wheel.warnings) add(w);
  if (e.path) {
    for (const core::Error& w : e.path->warnings) add(w);
  }
  return out;
}

/// Six decimals, never "-0.000000".
std::string word(char letter, double value) {
  std::string digits = fmt::format("{:.6f}", value);
  if (digits == "-0.000000") digits.erase(0, 1);
  return fmt::format("{}{}", letter, digits);
}

}  // namespace

nlohmann::ordered_json wheel_json(const fit::WheelEvaluation& evaluation,
                                  const fit::WheelTask& task) {
  const fit::WheelMeasurement& m = evaluation.wheel;
  Json out = {{"shape", "wheel"},
              {"mode", fit::name_of(m.mode)},
              {"points", m.points},
              {"dropped",
               list_json(m.dropped,
                         [](const fit::DroppedPoint& p) -> Json {
                           return {{"row", p.row}, {"deviation_um", micrometres(p.deviation_mm)}};
                         })},
              {"center_by", fit::name_of(m.mean)},
              {"center_mm", point(m.center_mm)},
              {"center_uncertainty_um", micrometres(m.center_uncertainty_mm)},
              {"radius_mm", m.radius_mm},
              {"radius_uncertainty_um", micrometres(m.radius_uncertainty_mm)},
              {"spread_um", micrometres(m.spread_mm)},
              {"deviation_um", micrometres(m.deviation_mm)},
              {"coverage_deg", in_deg(m.order.coverage_rad())},
              {"amplification", {{"center", m.factors.center}, {"radius", m.factors.radius}}},
              {"correlation", m.correlation},
              {"quadruples", quadruples(m, task.wheel.quadruples)},
              {"ls",
               {{"center_mm", point(m.check.center_mm)},
                {"radius_mm", m.check.radius_mm},
                {"deviation_um", micrometres(m.check.deviation_mm)}}},
              {"mz", zone(m)},
              {"runout", runout(m)}};
  if (!m.radius_void_because.empty()) out["radius_void_because"] = m.radius_void_because;
  if (!m.runout) out["runout_absent"] = m.runout_absent;
  out["effective_radius_mm"] = optional_json(m.effective_radius_mm());
  out["limits"] = limits(task.wheel);
  if (task.path) {
    out["path"] = evaluation.path ? path_json(*evaluation.path, *task.path) : Json(nullptr);
    out["forecast"] = evaluation.forecast ? forecast(*evaluation.forecast) : Json(nullptr);
    if (evaluation.refused) {
      out["path_refused"] = {{"code", core::code_name(evaluation.refused->code)},
                             {"what", evaluation.refused->what}};
    }
  }
  out["warnings"] = warnings(evaluation);
  out["curves"] = curves(evaluation);
  return out;
}

std::string wheel_path_csv(const fit::WheelPath& path) {
  std::string out = fmt::format(
      "# wheel-centre path for R = {} mm; xc, zc: wheel {}\n"
      "x_mm,f_mm,slope,xc_mm,zc_mm,phi_deg,R_ks,clearance_um\n",
      core::shortest(path.radius_mm), path.lowest_point ? "lowest point" : "centre");
  for (const fit::WheelPathRow& row : path.rows) {
    const double values[] = {row.x_mm,
                             row.surface.height_mm,
                             row.surface.slope,
                             row.center_mm.x(),
                             path.machine_z_mm(row),
                             row.contact_rad / core::kDegree,
                             row.load,
                             row.clearance_mm / core::kMicrometre};
    const char* separator = "";
    for (const double value : values) {
      out += separator;
      out += core::shortest(value + 0.0);
      separator = ",";
    }
    out += '\n';
  }
  return out;
}

std::string wheel_gcode(const fit::WheelPath& path, const GcodeOptions& options) {
  double top = path.machine_z_mm(path.rows.front());
  for (const fit::WheelPathRow& row : path.rows) top = std::max(top, path.machine_z_mm(row));
  const std::string above = word('Z', top + options.retract_mm);
  const fit::WheelPathRow& first = path.rows.front();
  std::string out = fmt::format(
      "%\n(RONDURE {} WHEEL PATH)\n(WHEEL RADIUS {:.6f} MM, X Z ARE THE WHEEL {})\n"
      "(X AS RADIUS, STEP {:.6f} MM, {} PLACES)\n"
      "G21 G90 G94 G18\nG0 {}\nG0 {}\nG1 {} F{}\n",
      core::kVersion, path.radius_mm, path.lowest_point ? "LOWEST POINT" : "CENTRE", path.step_mm,
      path.rows.size(), above, word('X', first.center_mm.x()), word('Z', path.machine_z_mm(first)),
      core::shortest(options.feed_mm_min));
  for (auto row = path.rows.begin() + 1; row != path.rows.end(); ++row) {
    out += fmt::format("G1 {} {}\n", word('X', row->center_mm.x()),
                       word('Z', path.machine_z_mm(*row)));
  }
  return out + fmt::format("G0 {}\nM30\n%\n", above);
}

}  // namespace rondure::reports
