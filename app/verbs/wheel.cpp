#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "core/units.h"
#include "evaluation/wheel/result.h"
#include "fit/wheel/evaluation.h"
#include "fit/wheel/surface.h"
#include "record/csv/series.h"
#include "record/files.h"
#include "reports/data/wheel.h"

namespace rondure::app {
namespace {

std::string center_words(const fit::WheelMeasurement& m) {
  if (m.mean == fit::WheelMean::kLeastSquares) return "least squares";
  return fmt::format("mean of {} quadruples", m.centers.accepted.size());
}

/// The other centre: of the quadruples or of least squares.
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
  if (const std::string why = m.radius_void_because; !why.empty()) {
    out += fmt::format("            centre and radius prove nothing: {}\n", why);
  }
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

/// Effect of the run-out on a path for the mean radius.
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
  return out + no_interval_text("wheel");
}

constexpr std::size_t kMostEvenTerms = 10;

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = text.find(',');
    out.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return out;
    text.remove_prefix(comma + 1);
  }
}

core::Result<double> number(std::string_view text, std::string_view of) {
  if (const auto value = core::parse_number(text)) return *value;
  return core::fail_with(core::Code::kBadOption,
                         "--surface: {} is \"{}\"; a number such as 12.5 is expected", of, text);
}

core::Result<fit::WheelSurface> read_polynomial(std::string_view words) {
  fit::Polynomial out;
  for (const std::string_view word : split(words)) {
    TRY(const auto value, number(word, fmt::format("a{}", out.coefficients.size())));
    out.coefficients.push_back(value);
  }
  return fit::WheelSurface::polynomial(std::move(out));
}

/// 0 for A2, 1 for A4, ...; none for another name.
std::optional<std::size_t> even_term(std::string_view name) {
  for (std::size_t i = 0; i < kMostEvenTerms; ++i) {
    if (name == fmt::format("A{}", 2 * (i + 1))) return i;
  }
  return std::nullopt;
}

core::Result<void> set_term(std::string_view name, double value, fit::Asphere& out) {
  if (name == "R" && value != 0.0) {
    out.curvature_per_mm = 1.0 / value;
  } else if (name == "c") {
    out.curvature_per_mm = value;
  } else if (name == "K") {
    out.conic = value;
  } else if (const auto term = even_term(name)) {
    out.even_terms.resize(std::max(out.even_terms.size(), *term + 1));
    out.even_terms[*term] = value;
  } else {
    return core::fail_with(
        core::Code::kBadOption,
        "--surface: an asphere has R (not 0) or c, K, A2, A4, ... A{}; there is \"{}={}\"",
        2 * kMostEvenTerms, name, core::shortest(value));
  }
  return {};
}

core::Result<fit::WheelSurface> read_asphere(std::string_view words) {
  fit::Asphere out;
  for (const std::string_view word : split(words)) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) {
      return core::fail_with(core::Code::kBadOption,
                             "--surface: \"{}\" has no =; write asphere:R=120,K=-1,A4=2e-8", word);
    }
    TRY(const auto value, number(word.substr(equals + 1), word.substr(0, equals)));
    TRY_DO(set_term(word.substr(0, equals), value, out));
  }
  return fit::WheelSurface::asphere(std::move(out));
}

core::Result<record::Series> read_table(const std::string& file,
                                        std::span<const record::WantedColumn> columns) {
  TRY(const auto bytes, record::read_file(file, record::kMostPointsBytes));
  return record::parse_series_csv(bytes, std::filesystem::path(file).filename().string(), columns);
}

core::Error in_file(const core::Error& error, const std::string& file) {
  return error.at(std::filesystem::path(file).filename().string());
}

/// Parses a surface from one word of the command line:
///   polynomial:a0,a1,a2,...          z = a0 + a1 x + a2 x^2 + ... [mm^(1-j)]
///   asphere:R=120,K=-1,A4=2e-8,...   vertex radius [mm] (or c=1/mm), conic, even terms A2 to A20
///   table:FILE.csv                   columns x,z (mm)
/// @return kBadOption with the word; the errors of the file and of WheelSurface.
core::Result<fit::WheelSurface> read_surface(const std::string& word) {
  const std::string_view text = word;
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  if (kind == "polynomial") return read_polynomial(rest);
  if (kind == "asphere") return read_asphere(rest);
  if (kind != "table") {
    return core::fail_with(core::Code::kBadOption,
                           "--surface is \"{}\"; polynomial:a0,a1,..., asphere:R=..,K=..,A4=.. or "
                           "table:FILE.csv are known",
                           word);
  }
  const std::string file(rest);
  TRY(const auto table, read_table(file, std::array<record::WantedColumn, 2>{{{"x"}, {"z"}}}));
  auto surface = fit::WheelSurface::table(*table.column("x"), *table.column("z"));
  if (!surface) return core::fail(in_file(surface.error(), file));
  return surface;
}

/// The surface minus the removal in a file with the columns x,depth_um (mm, um).
core::Result<fit::WheelSurface> take_removal(const fit::WheelSurface& surface,
                                             const std::string& file) {
  TRY(const auto table,
      read_table(file, std::array<record::WantedColumn, 2>{{{"x"}, {"depth_um"}}}));
  std::vector<double> depth = *table.column("depth_um");
  for (double& d : depth) d *= core::kMicrometre;
  auto out = surface.less(*table.column("x"), std::move(depth));
  if (!out) return core::fail(in_file(out.error(), file));
  return out;
}

using Points = std::vector<Eigen::Vector2d>;

core::Result<Points> load_wheel(const std::string& file) {
  constexpr std::array<record::WantedColumn, 3> kWheelColumns = {
      {{"x"}, {"z", false}, {"y", false}}};
  TRY(const auto table, read_table(file, kWheelColumns));
  const auto z = table.column("z");
  const auto y = table.column("y");
  if (z.has_value() == y.has_value()) {
    return core::fail(in_file(
        {core::Code::kSyntax, "a wheel needs the columns x,z or x,y (mm): one of z and y", {}},
        file));
  }
  const auto x = table.column("x");
  Points out;
  for (std::size_t i = 0; i < x->size(); ++i) out.emplace_back((*x)[i], (z ? *z : *y)[i]);
  return out;
}

fit::WheelOptions measuring_options(const WheelArguments& a) {
  fit::WheelOptions out = evaluation::wheel_options(a.task, a.seed);
  if (!a.axis_mm.empty()) out.axis_mm = Eigen::Vector2d(a.axis_mm[0], a.axis_mm[1]);
  return out;
}

core::Result<fit::WheelPathOptions> path_options(const WheelArguments& a,
                                                 const fit::WheelSurface& surface) {
  fit::WheelPathOptions out;
  const auto whole = surface.range_mm();
  if (a.range_mm.empty() && !whole) {
    return core::fail(core::Code::kBadOption,
                      "--range-mm is missing: a formula does not say where the part ends");
  }
  out.from_mm = a.range_mm.empty() ? whole->first : a.range_mm[0];
  out.to_mm = a.range_mm.empty() ? whole->second : a.range_mm[1];
  if (!a.surface_range_mm.empty()) {
    out.surface_from_mm = a.surface_range_mm[0];
    out.surface_to_mm = a.surface_range_mm[1];
  } else if (whole) {
    out.surface_from_mm = whole->first;
    out.surface_to_mm = whole->second;
  }
  out.step_mm = a.step_mm;
  if (a.cusp_um) out.cusp_mm = *a.cusp_um * core::kMicrometre;
  if (!a.wheel_arc_deg.empty()) {
    out.least_contact_rad = a.wheel_arc_deg[0] * core::kDegree;
    out.greatest_contact_rad = a.wheel_arc_deg[1] * core::kDegree;
  }
  out.lowest_point = a.lowest_point;
  return out;
}

core::Result<fit::WheelTask> task_of(const WheelArguments& a) {
  fit::WheelTask out{measuring_options(a), {}};
  if (a.surface.empty()) {
    if (a.path.empty() && a.gcode.empty() && a.removal.empty()) return out;
    return core::fail(core::Code::kBadOption,
                      "--path, --gcode and --removal need --surface: what is to be ground?");
  }
  auto surface = read_surface(a.surface);
  if (surface && !a.removal.empty()) surface = take_removal(*surface, a.removal);
  if (!surface) return core::fail(surface.error());
  TRY(const auto options, path_options(a, *surface));
  fit::WheelPathTask path{*std::move(surface), options, fit::RadiusChoice::kMean,
                          a.repeatability_um * core::kMicrometre, a.touch_off_mm};
  if (a.radius == record::GroundSurfaceTask::Radius::kEffective)
    path.radius = fit::RadiusChoice::kEffective;
  out.path = std::move(path);
  return out;
}

core::Result<void> write_files(const WheelArguments& a, const fit::WheelPath& path) {
  if (!a.path.empty()) {
    if (auto done = record::write_file(a.path, reports::wheel_path_csv(path)); !done) return done;
  }
  if (a.gcode.empty()) return {};
  return record::write_file(a.gcode, reports::wheel_gcode(path, {a.feed_mm_min, a.retract_mm}));
}

}  // namespace

int wheel(const WheelArguments& arguments) {
  const auto task = task_of(arguments);
  if (!task) return refuse(task.error());
  const auto points = load_wheel(arguments.file);
  if (!points) return refuse_file(points.error(), arguments.file);
  const auto evaluation = fit::evaluate_wheel(*points, *task);
  if (!evaluation) return refuse_file(evaluation.error(), arguments.file);
  auto found = reports::wheel_json(*evaluation, *task);
  add_no_interval(found, "wheel");
  if (const auto finite = check_finite(found); !finite) {
    return refuse_file(finite.error(), arguments.file);
  }
  if (evaluation->path) {
    if (auto written = write_files(arguments, *evaluation->path); !written) {
      return refuse(written.error());
    }
  }
  // The measurement of the wheel is valid even where the surface cannot be ground with it.
  const int status = answer(found, arguments.json, [&] { return wheel_table(*evaluation, *task); });
  return evaluation->refused ? refuse(*evaluation->refused) : status;
}

}  // namespace rondure::app
