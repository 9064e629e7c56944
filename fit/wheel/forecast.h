#pragma once

#include <optional>
#include <vector>

#include "core/result.h"
#include "fit/wheel/path.h"

namespace rondure::fit {

/// Form error at one place of a ground surface; above 0: material left on, below 0: overcut.
struct ResidualRow {
  double x_mm = 0.0;
  double vertical_mm = 0.0;  ///< e_z = delta q.
  double touched_mm = 0.0;   ///< delta (q - q(x0)): what the touch-off at x0 leaves.
};

/// What a path for one radius leaves when the wheel has another.
struct ResidualForm {
  double used_radius_mm = 0.0;
  double true_radius_mm = 0.0;
  double delta_mm = 0.0;      ///< used - true: the error along the normal.
  double touch_off_mm = 0.0;  ///< x0
  std::vector<ResidualRow> rows;
  double deviation_mm = 0.0;  ///< Peak to valley after touch-off.
};

/// Residual form over the places of a path's range: its step, 1000 places at most.
///
/// e_z = delta q + O(delta^2 k_s). Only where the true wheel does not gouge.
/// @return as wheel_load() of the true radius; kBadOption for radii not above 0.
/// Source: methods, wheel section 9.
[[nodiscard]] core::Result<ResidualForm> residual_form(const WheelSurface& surface,
                                                       double used_radius_mm, double true_radius_mm,
                                                       double touch_off_mm,
                                                       const WheelPathOptions& options);

/// What is known of a wheel when its path is computed.
struct ForecastInput {
  double radius_mm = 0.0;                   ///< Of the path, taken for true.
  double radius_uncertainty_mm = 0.0;       ///< Standard.
  std::optional<double> nominal_radius_mm;  ///< What an uncompensated path would take.
  double repeatability_mm = 0.0;            ///< Of the machine: no compensation is better.
  double touch_off_mm = 0.0;                ///< x0
};

/// Residual form without and with compensation.
struct WheelForecast {
  std::optional<ResidualForm> nominal;  ///< Path for the nominal radius.
  ResidualForm measured;                ///< Path for the measured one, 2 u(R) off.
  std::optional<double> improvement;    ///< |delta_nominal| / max(2 u(R), repeatability).
  bool capped = false;                  ///< The machine's repeatability limits it.
};

/// @return as residual_form().
[[nodiscard]] core::Result<WheelForecast> forecast(const WheelSurface& surface,
                                                   const ForecastInput& input,
                                                   const WheelPathOptions& options);

}  // namespace rondure::fit
