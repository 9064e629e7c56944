#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "fit/wheel/surface.h"

namespace rondure::fit {

/// Range, spacing and limits of wheel_path(). A value outside its range gives Code::kBadOption.
struct WheelPathOptions {
  double from_mm = 0.0;           ///< First contact, x [mm].
  double to_mm = 0.0;             ///< Last contact, > from_mm.
  double step_mm = 0.1;           ///< Largest step of x, > 0; at most 1e6 steps.
  std::optional<double> cusp_mm;  ///< In place of the step: highest cusp between passes, > 0.
  std::optional<double> surface_from_mm;  ///< Where the surface begins that must not be cut into;
  std::optional<double> surface_to_mm;    ///< none: the range of contacts.
  double load_limit = 0.98;               ///< Largest R k_s, 0 to 1.
  double load_warning = 0.9;              ///< R k_s above this is warned of.
  double clearance_mm = 1e-6;             ///< The wheel may be so far inside the surface, > 0.
  /// Trued arc of the wheel: contact angles it allows [rad].
  double least_contact_rad = -90.0 * core::kDegree;
  double greatest_contact_rad = 90.0 * core::kDegree;
  bool lowest_point = false;  ///< z of the wheel's lowest point in place of its centre.
};

/// One place of the wheel on its way.
struct WheelPathRow {
  double x_mm = 0.0;  ///< Contact.
  SurfacePoint surface;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< Wheel centre (x, z).
  double contact_rad = 0.0;   ///< phi = atan f', from the wheel's lowest point.
  double load = 0.0;          ///< R k_s; the path is regular below 1.
  double clearance_mm = 0.0;  ///< Least distance of the surface from the centre, less R.
};

/// Where a wheel comes closest to being too large.
struct WheelLoad {
  double load = 0.0;  ///< Greatest R k_s over the surface; <= 0: nowhere hollow.
  double x_mm = 0.0;
  double least_curvature_per_mm = 0.0;  ///< k_s where the surface is most raised.

  /// The least concave radius of curvature, R / load [mm].
  [[nodiscard]] double concave_radius_mm(double radius_mm) const { return radius_mm / load; }
};

/// The way of a wheel's centre.
struct WheelPath {
  double radius_mm = 0.0;
  std::vector<WheelPathRow> rows;  ///< By x.
  bool lowest_point = false;       ///< What machine_z_mm() gives.
  WheelLoad load;
  double step_mm = 0.0;               ///< Step of x.
  double cusp_mm = 0.0;               ///< Highest cusp between passes, s^2/8 (1/R - k_s).
  std::vector<core::Error> warnings;  ///< kLowMargin.

  /// z for the controller: of the centre, or of the lowest point [mm].
  [[nodiscard]] double machine_z_mm(const WheelPathRow& row) const;
};

/// Cusp that a wheel leaves between passes a step apart [mm].
[[nodiscard]] double cusp_height_mm(double step_mm, double radius_mm, double curvature_per_mm);

/// Greatest R k_s over the whole surface of a path: on a grid (2000 places, and five to a row of a
/// table), then refined.
/// @return kSurface; kGouge above options.load_limit, with radius, x and limit; kBadOption.
[[nodiscard]] core::Result<WheelLoad> wheel_load(const WheelSurface& surface, double radius_mm,
                                                 const WheelPathOptions& options);

/// Way of the centre of a wheel that grinds z = f(x): xc = x - R f'/q, zc = f + R/q.
///
/// @return kBadOption (range, step, radius not above 0), kSurface, kGouge: the radius against a
///         concave radius of curvature, or the wheel inside the surface away from its contact;
///         kWheelArc: the contact leaves the trued arc. No path is given then.
/// Source: methods, wheel section 8.
[[nodiscard]] core::Result<WheelPath> wheel_path(const WheelSurface& surface, double radius_mm,
                                                 const WheelPathOptions& options);

}  // namespace rondure::fit
