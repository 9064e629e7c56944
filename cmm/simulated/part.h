#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

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

/// Thickness of the block around a simulated bore of a part [mm].
inline constexpr double kBlockWall_mm = 20.0;

/// The real surface of a simulated cylinder in its own frame P: axis z, mid-length at z = 0.
/// It bounds a solid with flat ends at z = -half_length and z = +half_length: a shaft, or a
/// round block of outer radius  radius + wall  with a bore.
struct PartSurface {
  double radius_mm = 0.0;
  double half_length_mm = 0.0;
  bool inside = false;  ///< true: a bore in a block, false: a shaft.
  PartForm form;
  std::vector<SurfaceMark> marks = {};
  bool lower_end = true;  ///< false: no flat there; another surface of the part takes its place.
  bool upper_end = true;
  double wall_mm = kBlockWall_mm;  ///< Of the block around a bore.

  /// Radius at an angle and height.
  [[nodiscard]] double radius_at(double theta_rad, double z_mm) const;
  /// The same part with every length multiplied by `factor`, about the origin of P (thermal
  /// expansion).
  [[nodiscard]] PartSurface scaled(double factor) const;
};

/// The real surface of a simulated face, a ring, in its own frame: z is the outward normal, the
/// ring lies about the origin. Height of the surface, q and theta polar, t = q / outer:
///   h = tilt q cos(theta - toward) + saucer t^2 + wave t^2 cos(order theta).
/// Source: methods, drawing section 10.
struct FaceSurface {
  double inner_mm = 0.0;  ///< Radii of the ring.
  double outer_mm = 0.0;
  bool mirrored = false;  ///< theta counts the other way round, as seen from below.
  double tilt_rad = 0.0;
  double toward_rad = 0.0;
  double saucer_mm = 0.0;
  double wave_mm = 0.0;
  int wave_order = 2;

  /// @param x_mm, y_mm  In the frame of the face.
  [[nodiscard]] double height_at(double x_mm, double y_mm) const;
  [[nodiscard]] Eigen::Vector2d slope_at(double x_mm, double y_mm) const;
  [[nodiscard]] FaceSurface scaled(double factor) const;
};

/// The real surface of a simulated ball about the origin of its frame:
///   r = radius + sum of amplitude Re(e^(i phase) (u_x + i u_y)^order),   u the direction,
/// on the equator the lobes of a circle, nothing at the poles.
struct BallSurface {
  double radius_mm = 0.0;
  std::vector<Lobe> lobes;

  /// @param u  Unit vector.
  [[nodiscard]] double radius_at(const Eigen::Vector3d& u) const;
  /// Outward unit normal at the point in direction `u`.
  [[nodiscard]] Eigen::Vector3d normal_at(const Eigen::Vector3d& u) const;
  [[nodiscard]] BallSurface scaled(double factor) const;
};

/// Surfaces of one rigid part.
struct SimulatedPart {
  struct Placed {
    std::variant<PartSurface, FaceSurface, BallSurface> surface;
    Eigen::Isometry3d X_PS = Eigen::Isometry3d::Identity();  ///< Own frame in the part.
  };
  std::vector<Placed> surfaces;

  /// The same part with every length multiplied by `factor`, about the origin of P.
  [[nodiscard]] SimulatedPart scaled(double factor) const;
};

}  // namespace rondure::cmm
