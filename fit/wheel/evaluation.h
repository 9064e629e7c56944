#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "fit/geometry/points.h"
#include "fit/wheel/path.h"
#include "fit/wheel/wheel.h"

namespace rondure::fit {

/// Form error at one place of a ground surface; > 0: material remains, < 0: overcut.
struct ResidualRow {
  double x_mm = 0.0;
  double vertical_mm = 0.0;  ///< e_z = delta q.
  double touched_mm = 0.0;   ///< delta (q - q(x0)): remaining after touch-off at x0.
};

/// Form error left by a path that was computed for another radius than that of the wheel.
struct ResidualForm {
  double used_radius_mm = 0.0;
  double true_radius_mm = 0.0;
  double delta_mm = 0.0;      ///< used - true: the error along the normal.
  double touch_off_mm = 0.0;  ///< x0
  std::vector<ResidualRow> rows;
  double deviation_mm = 0.0;  ///< Peak to valley after touch-off.
};

/// Computes the residual form over the range of a path, at its step, with at most 1000 places.
///
/// e_z = delta q + O(delta^2 k_s). Valid only if the true wheel does not gouge.
/// @return as wheel_load() of the true radius; kBadOption for radii not above 0.
/// Source: methods, wheel section 9.
[[nodiscard]] core::Result<ResidualForm> residual_form(const WheelSurface& surface,
                                                       double used_radius_mm, double true_radius_mm,
                                                       double touch_off_mm,
                                                       const WheelPathOptions& options);

/// Data of a wheel that are known when its path is computed.
struct ForecastInput {
  double radius_mm = 0.0;                   ///< Radius of the path, taken as true.
  double radius_uncertainty_mm = 0.0;       ///< Standard uncertainty of `radius_mm`.
  std::optional<double> nominal_radius_mm;  ///< Radius that an uncompensated path would use.
  double repeatability_mm = 0.0;  ///< Repeatability of the machine: the limit of any compensation.
  double touch_off_mm = 0.0;      ///< x0
};

/// Residual form without and with compensation.
struct WheelForecast {
  std::optional<ResidualForm> nominal;  ///< Path for the nominal radius.
  ResidualForm measured;                ///< Path for the measured one, 2 u(R) off.
  std::optional<double> improvement;    ///< |delta_nominal| / max(2 u(R), repeatability).
  bool capped = false;                  ///< The repeatability of the machine limits it.
};

/// Computes the residual form without and with compensation.
/// @return as residual_form().
[[nodiscard]] core::Result<WheelForecast> forecast(const WheelSurface& surface,
                                                   const ForecastInput& input,
                                                   const WheelPathOptions& options);

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
