#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/simulated/part_surface.h"

namespace rondure::cmm {

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
