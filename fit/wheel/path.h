#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "fit/wheel/surface.h"

namespace rondure::fit {

/// Range, spacing and limits of wheel_path(). A value outside its range gives Code::kBadOption.
struct WheelPathOptions {
  double from_mm = 0.0;                   ///< First contact, x [mm].
  double to_mm = 0.0;                     ///< Last contact, > from_mm.
  double step_mm = 0.1;                   ///< Largest step of x, > 0; at most 1e6 steps.
  std::optional<double> cusp_mm;          ///< Replaces the step: highest cusp between passes, > 0.
  std::optional<double> surface_from_mm;  ///< Range of the surface that must not be cut into;
  std::optional<double> surface_to_mm;    ///< none: the range of contacts.
  double load_limit = 0.98;               ///< Largest R k_s, 0 to 1.
  double load_warning = 0.9;              ///< R k_s above this causes a warning.
  double clearance_mm = 1e-6;             ///< The wheel may cut this far into the surface, > 0.
  /// Contact angles within the trued arc of the wheel [rad].
  double least_contact_rad = -90.0 * core::kDegree;
  double greatest_contact_rad = 90.0 * core::kDegree;
  bool lowest_point = false;  ///< z of the lowest point of the wheel instead of its centre.
};

/// One position of the wheel on its path.
struct WheelPathRow {
  double x_mm = 0.0;  ///< Contact.
  SurfacePoint surface;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< Wheel centre (x, z).
  double contact_rad = 0.0;   ///< phi = atan f', from the lowest point of the wheel.
  double load = 0.0;          ///< R k_s; the path is regular below 1.
  double clearance_mm = 0.0;  ///< Least distance of the surface from the centre, minus R.
};

/// Greatest ratio of the wheel radius to a concave radius of the surface.
struct WheelLoad {
  double load = 0.0;  ///< Greatest R k_s over the surface; <= 0: nowhere concave.
  double x_mm = 0.0;
  double least_curvature_per_mm = 0.0;  ///< k_s where the surface is most convex.

  /// The least concave radius of curvature, R / load [mm].
  [[nodiscard]] double concave_radius_mm(double radius_mm) const { return radius_mm / load; }
};

/// The path of the wheel centre.
struct WheelPath {
  double radius_mm = 0.0;
  std::vector<WheelPathRow> rows;  ///< In the order of x.
  bool lowest_point = false;       ///< Selects the result of machine_z_mm().
  WheelLoad load;
  double step_mm = 0.0;               ///< Step of x.
  double cusp_mm = 0.0;               ///< Highest cusp between passes, s^2/8 (1/R - k_s).
  std::vector<core::Error> warnings;  ///< kLowMargin.

  /// z for the controller: of the centre, or of the lowest point [mm].
  [[nodiscard]] double machine_z_mm(const WheelPathRow& row) const;
};

/// Height of the cusp that a wheel leaves between passes one step apart [mm].
[[nodiscard]] double cusp_height_mm(double step_mm, double radius_mm, double curvature_per_mm);

/// Finds the greatest R k_s over the whole surface of a path: on a grid (2000 places, and five per
/// row of a table), then refined.
/// @return kSurface; kGouge above options.load_limit, with radius, x and limit; kBadOption.
[[nodiscard]] core::Result<WheelLoad> wheel_load(const WheelSurface& surface, double radius_mm,
                                                 const WheelPathOptions& options);

/// Path of the centre of a wheel that grinds z = f(x): xc = x - R f'/q, zc = f + R/q.
///
/// @return The whole path; or kBadOption (range, step, radius not above 0), kSurface, kGouge
///         (radius too large for a concave radius of curvature, or the wheel inside the surface
///         away from its contact), kWheelArc (the contact leaves the trued arc).
/// Source: methods, wheel section 8.
[[nodiscard]] core::Result<WheelPath> wheel_path(const WheelSurface& surface, double radius_mm,
                                                 const WheelPathOptions& options);

}  // namespace rondure::fit
