#include "fit/wheel/evaluation.h"

#include <algorithm>
#include <cmath>

#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

constexpr double kMostRows = 1000.0;

}  // namespace

core::Result<ResidualForm> residual_form(const WheelSurface& surface, double used_radius_mm,
                                         double true_radius_mm, double touch_off_mm,
                                         const WheelPathOptions& options) {
  if (!(used_radius_mm > 0.0) || !std::isfinite(used_radius_mm)) {
    return core::fail_with(core::Code::kBadOption,
                           "the radius of the path is {} mm; above 0 is needed", used_radius_mm);
  }
  // With a cusp the options have no step; the residual is smooth, so any fine step will do.
  TRY_DO(wheel_load(surface, true_radius_mm, options));
  TRY(const auto origin, surface.at(touch_off_mm));
  ResidualForm out;
  out.used_radius_mm = used_radius_mm;
  out.true_radius_mm = true_radius_mm;
  out.delta_mm = used_radius_mm - true_radius_mm;
  out.touch_off_mm = touch_off_mm;
  const double length = options.to_mm - options.from_mm;
  const double wanted = options.cusp_mm ? kMostRows : std::ceil(length / options.step_mm - 1e-9);
  const double steps = std::clamp(wanted, 1.0, kMostRows);
  Extremes touched;
  for (double i = 0.0; i <= steps; i += 1.0) {
    const double x = options.from_mm + i / steps * length;
    TRY(const auto point, surface.at(x));
    const double q = point.stretch();
    out.rows.push_back({x, out.delta_mm * q, out.delta_mm * (q - origin.stretch())});
    touched.take(out.rows.back().touched_mm);
  }
  out.deviation_mm = touched.width();
  return out;
}

core::Result<WheelForecast> forecast(const WheelSurface& surface, const ForecastInput& input,
                                     const WheelPathOptions& options) {
  WheelForecast out;
  const double left = 2.0 * input.radius_uncertainty_mm;
  TRY(auto measured,
      residual_form(surface, input.radius_mm + left, input.radius_mm, input.touch_off_mm, options));
  out.measured = std::move(measured);
  if (!input.nominal_radius_mm) return out;
  TRY(auto nominal, residual_form(surface, *input.nominal_radius_mm, input.radius_mm,
                                  input.touch_off_mm, options));
  out.capped = input.repeatability_mm > left;
  const double floor = std::max(left, input.repeatability_mm);
  if (floor > 0.0) out.improvement = std::abs(nominal.delta_mm) / floor;
  out.nominal = std::move(nominal);
  return out;
}

namespace {

core::Result<double> radius_of(const WheelMeasurement& wheel, RadiusChoice choice) {
  if (!wheel.radius_void_because.empty()) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("the radius proves nothing: {}", wheel.radius_void_because));
  }
  if (choice == RadiusChoice::kMean) return wheel.radius_mm;
  if (const auto effective = wheel.effective_radius_mm()) return *effective;
  if (wheel.runout) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("the effective radius is a lower bound only: {}",
                                   wheel.runout->bound_because));
  }
  return core::fail(core::Code::kMeaning,
                    "the effective radius is not known without the spindle axis; give the axis, "
                    "measure in envelope mode, or take the mean radius");
}

core::Result<void> add_path(const WheelTask& task, WheelEvaluation& out) {
  const WheelPathTask& wanted = *task.path;
  TRY(const auto radius, radius_of(out.wheel, wanted.radius));
  TRY(auto path, wheel_path(wanted.surface, radius, wanted.options));
  ForecastInput input;
  input.radius_mm = radius;
  input.radius_uncertainty_mm = out.wheel.radius_uncertainty_mm;
  input.nominal_radius_mm = task.wheel.nominal_radius_mm;
  input.repeatability_mm = wanted.repeatability_mm;
  input.touch_off_mm =
      wanted.touch_off_mm.value_or(std::clamp(0.0, wanted.options.from_mm, wanted.options.to_mm));
  TRY(auto forecast, fit::forecast(wanted.surface, input, wanted.options));
  out.path = std::move(path);
  out.forecast = std::move(forecast);
  return {};
}

}  // namespace

core::Result<WheelEvaluation> evaluate_wheel(PlanePoints points_mm, const WheelTask& task) {
  TRY(auto wheel, measure_wheel(points_mm, task.wheel));
  WheelEvaluation out;
  out.wheel = std::move(wheel);
  if (!task.path) return out;
  out.radius = task.path->radius;
  if (auto added = add_path(task, out); !added) out.refused = added.error();
  return out;
}

}  // namespace rondure::fit
