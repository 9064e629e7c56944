#pragma once

#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/wheel/wheel.h"
#include "fit/wheel/forecast.h"
#include "fit/wheel/path.h"

namespace rondure::fit {

/// Which radius the path is computed for.
enum class RadiusChoice {
  kMean,       ///< R
  kEffective,  ///< Farthest point from the axis: at many turns per contact it makes the surface.
};
/// "mean", "effective".
[[nodiscard]] std::string_view name_of(RadiusChoice choice);

/// A path to compute from the measured radius.
struct WheelPathTask {
  WheelSurface surface;
  WheelPathOptions options;
  RadiusChoice radius = RadiusChoice::kMean;
  double repeatability_mm = 0.0;       ///< Of the grinding machine.
  std::optional<double> touch_off_mm;  ///< x0; none: 0, or the nearest end of the path.
};

/// What to do with the points of a wheel.
struct WheelTask {
  WheelOptions wheel;
  std::optional<WheelPathTask> path;
};

/// A wheel and what it will grind.
struct WheelEvaluation {
  WheelMeasurement wheel;
  RadiusChoice radius = RadiusChoice::kMean;
  std::optional<WheelPath> path;
  std::optional<WheelForecast> forecast;
  std::optional<core::Error> refused;  ///< Why there is no path though one was asked for.
};

/// Measures the wheel, then computes path and forecast.
///
/// @return the errors of measure_wheel(). A path that cannot be given is no error: see `refused`
///         (those of wheel_path(); kMeaning for an effective radius that is not known, or known as
///         a bound).
[[nodiscard]] core::Result<WheelEvaluation> evaluate_wheel(
    std::span<const Eigen::Vector2d> points_mm, const WheelTask& task);

}  // namespace rondure::fit
