#pragma once

#include <vector>

#include "core/result.h"

namespace rondure::cmm {

/// One lobing term of the form: amplitude * cos(order * theta + phase + twist * q).
struct Lobe {
  int order = 2;  ///< UPR.
  double amplitude_mm = 0.0;
  double phase_rad = 0.0;
  double twist_rad = 0.0;  ///< Helix: change of phase from mid-length to the upper end.
};

/// Form of a simulated part, radial, positive outward from the axis. q runs from -1 at the lower
/// end to +1 at the upper end:
///   dr = sum of lobes + taper q + barrel (q^2 - 1/3) + bend (q^2 - 1/3) cos(theta + bend_phase).
/// Source: methods, cylindricity section 12.
struct PartForm {
  std::vector<Lobe> lobes;
  double taper_mm = 0.0;
  double barrel_mm = 0.0;
  double bend_mm = 0.0;
  double bend_phase_rad = 0.0;
};

/// A keyway, a burr, a flat spot: a raised or sunk patch of the surface. Its flanks are C2:
///   dr = height W(u) W(z),  W = 1 within the patch but for its flanks, 0 outside,
/// u along the circumference at the nominal radius; the floor follows the surface.
struct SurfaceMark {
  double theta_rad = 0.0;  ///< Angle of the middle.
  double z_mm = 0.0;       ///< Height of the middle, from mid-length.
  double width_mm = 0.0;   ///< Width along the circumference, flanks included; > 0.
  double length_mm = 0.0;  ///< Length along the axis, flanks included; > 0.
  double height_mm = 0.0;  ///< Height toward the free side: a burr > 0, a keyway < 0.
  double flank_mm = 0.1;   ///< Width of each flank; > 0, at most half of width and length.
};

/// Thickness of the block around a simulated bore [mm].
inline constexpr double kBlockWall_mm = 20.0;

/// The real surface of a simulated cylinder in its own frame P: axis z, mid-length at z = 0.
/// It bounds a solid with flat ends at z = -half_length and z = +half_length: a shaft, or a
/// round block of outer radius  radius + kBlockWall_mm  with a bore.
struct PartSurface {
  double radius_mm = 0.0;
  double half_length_mm = 0.0;
  bool inside = false;  ///< true: a bore in a block, false: a shaft.
  PartForm form;
  std::vector<SurfaceMark> marks = {};
  bool lower_end = true;  ///< false: no flat there; another surface of the part takes its place.
  bool upper_end = true;

  /// Radius at an angle and height.
  [[nodiscard]] double radius_at(double theta_rad, double z_mm) const;
  /// The same part with every length multiplied by `factor`, about the origin of P (thermal
  /// expansion).
  [[nodiscard]] PartSurface scaled(double factor) const;
};

}  // namespace rondure::cmm
