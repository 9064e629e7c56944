#include "fit/wheel/forecast.h"

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

}  // namespace rondure::fit
