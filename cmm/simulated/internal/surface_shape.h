#pragma once

#include <Eigen/Core>

#include "cmm/simulated/part.h"

namespace rondure::cmm {

/// Radius of a part surface with its partial derivatives; t stands for theta [rad], z in mm.
struct RadiusDerivatives {
  double r_mm = 0.0;
  double t = 0.0;
  double z = 0.0;
  double tt = 0.0;
  double tz = 0.0;
  double zz = 0.0;
};

[[nodiscard]] RadiusDerivatives radius_derivatives(const PartSurface& surface, double theta_rad,
                                                   double z_mm);

/// A point of the surface, X = (r cos theta, r sin theta, z), with its derivatives by
/// u = radius * theta [mm] and z [mm]: both parameters are lengths of the same size.
struct SurfaceJet {
  Eigen::Vector3d x_mm;
  Eigen::Vector3d u;
  Eigen::Vector3d z;
  Eigen::Vector3d uu;
  Eigen::Vector3d uz;
  Eigen::Vector3d zz;
};

[[nodiscard]] SurfaceJet surface_jet(const PartSurface& surface, double u_mm, double z_mm);

/// Bounds that hold everywhere on a surface.
struct ShapeBounds {
  double deviation_mm = 0.0;         ///< |r - radius|.
  double toward_free_mm = 0.0;       ///< r - radius of a shaft, radius - r of a bore.
  double stretch_u = 0.0;            ///< |dX/du|.
  double stretch_z = 0.0;            ///< |dX/dz|.
  double form_curvature_1_mm = 0.0;  ///< Form without the ideal cylinder [1/mm].
  double wavelength_mm = 0.0;        ///< Finest undulation, in either direction of the surface.
};

[[nodiscard]] ShapeBounds shape_bounds(const PartSurface& surface);
/// Bounds of the surface outside all marks.
[[nodiscard]] ShapeBounds bounds_beside_marks(const PartSurface& surface);

/// Stretches and finest undulation within a box of the parameters (u, z). A flank of a mark is
/// steep only across itself, and only where it is.
struct BoxBounds {
  double stretch_u = 0.0;
  double stretch_z = 0.0;
  double wavelength_mm = 0.0;
};
/// @param beside  bounds_beside_marks() of the surface.
[[nodiscard]] BoxBounds bounds_in_box(const PartSurface& surface, const ShapeBounds& beside,
                                      const Eigen::Vector2d& center_mm,
                                      const Eigen::Vector2d& half_mm);

}  // namespace rondure::cmm
