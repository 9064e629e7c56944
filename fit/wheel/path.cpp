#include "fit/wheel/path.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fit/wheel/surface.h"

namespace rondure::fit {
namespace {

constexpr double kMostSteps = 1e6;

core::Result<void> check(double radius_mm, const WheelPathOptions& o) {
  if (!(radius_mm > 0.0) || !std::isfinite(radius_mm)) {
    return core::fail_with(core::Code::kBadOption, "the wheel radius is {} mm; above 0 is needed",
                           radius_mm);
  }
  if (!(o.to_mm > o.from_mm) || !std::isfinite(o.to_mm - o.from_mm)) {
    return core::fail_with(core::Code::kBadOption,
                           "the path runs from {} to {} mm; the end must lie above", o.from_mm,
                           o.to_mm);
  }
  const bool steps = o.cusp_mm ? *o.cusp_mm > 0.0
                               : o.step_mm > 0.0 && (o.to_mm - o.from_mm) / o.step_mm <= kMostSteps;
  if (!steps) {
    return core::fail_with(core::Code::kBadOption,
                           "step {} mm, cusp {} mm: above 0, and at most {:.0f} steps, are needed",
                           o.step_mm, o.cusp_mm.value_or(0.0), kMostSteps);
  }
  if (o.surface_from_mm.value_or(o.from_mm) > o.from_mm ||
      o.surface_to_mm.value_or(o.to_mm) < o.to_mm) {
    return core::fail_with(core::Code::kBadOption,
                           "the surface, {} to {} mm, must hold the contacts, {} to {} mm",
                           o.surface_from_mm.value_or(o.from_mm), o.surface_to_mm.value_or(o.to_mm),
                           o.from_mm, o.to_mm);
  }
  if (o.load_limit > 0.0 && o.load_limit <= 1.0 && o.clearance_mm > 0.0) return {};
  return core::fail_with(core::Code::kBadOption,
                         "limit of R k_s {} (0 to 1), clearance {} mm (above 0)", o.load_limit,
                         o.clearance_mm);
}

core::Result<SurfaceSamples> sample_of(const WheelSurface& surface,
                                       const WheelPathOptions& options) {
  return SurfaceSamples::over(surface, options.surface_from_mm.value_or(options.from_mm),
                              options.surface_to_mm.value_or(options.to_mm));
}

/// Rounds x for a message: no "-0", no digits of round-off.
double shown(double x_mm) { return std::round(x_mm * 1e4) / 1e4 + 0.0; }

/// The load of a surface; kGouge above the limit of the options.
core::Result<WheelLoad> load_of(const SurfaceSamples& samples, double radius_mm,
                                const WheelPathOptions& options) {
  const SurfaceSamples::Place worst = samples.greatest_curvature();
  const WheelLoad load{worst.value * radius_mm, worst.x_mm, samples.least_curvature_per_mm()};
  if (load.load <= options.load_limit) return load;
  const double concave = load.concave_radius_mm(radius_mm);
  if (load.load >= 1.0) {
    return core::fail_with(core::Code::kGouge,
                           "wheel radius R = {:.6g} mm exceeds the concave radius of curvature "
                           "{:.6g} mm at x = {} mm; a wheel of at most {:.6g} mm can grind it",
                           radius_mm, concave, shown(load.x_mm), options.load_limit * concave);
  }
  return core::fail_with(core::Code::kGouge,
                         "wheel radius R = {:.6g} mm is {:.4f} of the concave radius of curvature "
                         "{:.6g} mm at x = {} mm; the limit is {} ({:.6g} mm)",
                         radius_mm, load.load, concave, shown(load.x_mm), options.load_limit,
                         options.load_limit * concave);
}

core::Result<void> check_contact(const WheelPathRow& row, const WheelPathOptions& options) {
  if (row.contact_rad >= options.least_contact_rad &&
      row.contact_rad <= options.greatest_contact_rad) {
    return {};
  }
  return core::fail_with(core::Code::kWheelArc,
                         "the contact at x = {} mm lies {:.3f} deg from the wheel's lowest point, "
                         "outside its trued arc, {:.3f} to {:.3f} deg",
                         shown(row.x_mm), row.contact_rad / core::kDegree,
                         options.least_contact_rad / core::kDegree,
                         options.greatest_contact_rad / core::kDegree);
}

core::Result<WheelPathRow> row_at(const WheelSurface& surface, double x_mm, double radius_mm) {
  TRY(const auto point, surface.at(x_mm));
  WheelPathRow row;
  row.x_mm = x_mm;
  row.surface = point;
  const double q = point.stretch();
  row.center_mm = {x_mm - radius_mm * point.slope / q, point.height_mm + radius_mm / q};
  row.contact_rad = std::atan(point.slope);
  row.load = radius_mm * point.curvature_per_mm();
  return row;
}

core::Result<void> check_clearance(const SurfaceSamples& samples, const WheelPathOptions& options,
                                   WheelPath& path) {
  for (WheelPathRow& row : path.rows) {
    const SurfaceSamples::Place least = samples.nearest(row.center_mm, path.radius_mm);
    row.clearance_mm = least.value - path.radius_mm;
    if (row.clearance_mm >= -options.clearance_mm) continue;
    return core::fail_with(core::Code::kGouge,
                           "with contact at x = {} mm the wheel of radius {:.6g} mm is {:.3g} mm "
                           "inside the surface at x = {} mm; the limit is {} mm",
                           shown(row.x_mm), path.radius_mm, -row.clearance_mm, shown(least.x_mm),
                           options.clearance_mm);
  }
  return {};
}

core::Result<void> fill_rows(const WheelSurface& surface, const WheelPathOptions& options,
                             WheelPath& path) {
  const double length = options.to_mm - options.from_mm;
  // The slack prevents round-off from adding a step to a whole number of them.
  const double steps = std::max(1.0, std::ceil(length / path.step_mm * (1.0 - 1e-12)));
  if (steps > kMostSteps) {
    return core::fail_with(core::Code::kBadOption,
                           "a cusp of {} um needs {:.0f} steps; the limit is {:.0f}",
                           options.cusp_mm.value_or(0.0) / core::kMicrometre, steps, kMostSteps);
  }
  path.step_mm = length / steps;
  const auto count = static_cast<std::size_t>(steps);
  for (std::size_t i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / steps;
    TRY(const auto row, row_at(surface, options.from_mm + share * length, path.radius_mm));
    if (auto checked = check_contact(row, options); !checked) return checked;
    path.rows.push_back(row);
  }
  return {};
}

}  // namespace

double WheelPath::machine_z_mm(const WheelPathRow& row) const {
  return row.center_mm.y() - (lowest_point ? radius_mm : 0.0);
}

double cusp_height_mm(double step_mm, double radius_mm, double curvature_per_mm) {
  return step_mm * step_mm / 8.0 * (1.0 / radius_mm - curvature_per_mm);
}

core::Result<WheelLoad> wheel_load(const WheelSurface& surface, double radius_mm,
                                   const WheelPathOptions& options) {
  TRY_DO(check(radius_mm, options));
  TRY(const auto samples, sample_of(surface, options));
  return load_of(samples, radius_mm, options);
}

core::Result<WheelPath> wheel_path(const WheelSurface& surface, double radius_mm,
                                   const WheelPathOptions& options) {
  TRY_DO(check(radius_mm, options));
  TRY(const auto samples, sample_of(surface, options));
  TRY(const auto load, load_of(samples, radius_mm, options));
  WheelPath path;
  path.radius_mm = radius_mm;
  path.lowest_point = options.lowest_point;
  path.load = load;
  const double relief = 1.0 / radius_mm - path.load.least_curvature_per_mm;
  path.step_mm = options.cusp_mm ? std::sqrt(8.0 * *options.cusp_mm / relief) : options.step_mm;
  TRY_DO(fill_rows(surface, options, path));
  path.cusp_mm = cusp_height_mm(path.step_mm, radius_mm, path.load.least_curvature_per_mm);
  TRY_DO(check_clearance(samples, options, path));
  if (path.load.load > options.load_warning) {
    path.warnings.push_back(
        {core::Code::kLowMargin,
         fmt::format("R k_s reaches {:.4f} at x = {} mm, close to 1: the concave radius there is "
                     "{:.6g} mm",
                     path.load.load, shown(path.load.x_mm),
                     path.load.concave_radius_mm(radius_mm))});
  }
  return path;
}

}  // namespace rondure::fit
