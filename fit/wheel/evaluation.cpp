#include "fit/wheel/evaluation.h"

#include <algorithm>

namespace rondure::fit {
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
