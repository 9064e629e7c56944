#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "fit/geometry/points.h"
#include "fit/wheel/forecast.h"
#include "fit/wheel/path.h"
#include "fit/wheel/wheel.h"

namespace rondure::fit {

/// Radius for which the path is computed.
enum class RadiusChoice {
  kMean,       ///< R
  kEffective,  ///< Farthest point from the axis, which cuts at many turns per contact.
};
RONDURE_WORDS(RadiusChoice, {kMean, "mean"}, {kEffective, "effective"});

/// A path to compute from the measured radius.
struct WheelPathTask {
  WheelSurface surface;
  WheelPathOptions options;
  RadiusChoice radius = RadiusChoice::kMean;
  double repeatability_mm = 0.0;       ///< Repeatability of the grinding machine.
  std::optional<double> touch_off_mm;  ///< x0; none: 0, or the nearest end of the path.
};

/// Evaluation to make from the points of a wheel.
struct WheelTask {
  WheelOptions wheel;
  std::optional<WheelPathTask> path;
};

/// Results for a wheel, its path and the form that it will grind.
struct WheelEvaluation {
  WheelMeasurement wheel;
  RadiusChoice radius = RadiusChoice::kMean;
  std::optional<WheelPath> path;
  std::optional<WheelForecast> forecast;
  std::optional<core::Error> refused;  ///< Why there is no path although one was requested.
};

/// Measures the wheel, then computes path and forecast.
///
/// @return the errors of measure_wheel(). A path that cannot be computed is not an error: see
///         `refused` (errors of wheel_path(); kMeaning for a radius that proves nothing, or an
///         effective radius that is unknown or only a bound).
[[nodiscard]] core::Result<WheelEvaluation> evaluate_wheel(PlanePoints points_mm,
                                                           const WheelTask& task);

}  // namespace rondure::fit
