#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rondure::cmm {

// The hidden errors of a simulated machine, probe and part. Everything zero: ideal. Units, typical
// values and sources: docs/simulation.md.

/// One parametric error along the travel p of its axis, p counted from the machine origin:
///   e(p) = linear p + quadratic p^2 + wave sin(2 pi p / period + phase).
/// The value is mm for a translation, rad for a rotation.
struct ErrorCurve {
  double linear_1_mm = 0.0;      ///< mm/mm, or rad/mm.
  double quadratic_1_mm2 = 0.0;  ///< mm/mm^2, or rad/mm^2.
  double wave = 0.0;             ///< mm, or rad.
  double period_mm = 100.0;      ///< > 0.
  double phase_rad = 0.0;

  [[nodiscard]] double at(double p_mm) const {
    constexpr double kTurn = 6.283185307179586;
    const double smooth = p_mm * (linear_1_mm + quadratic_1_mm2 * p_mm);
    return wave == 0.0 ? smooth : smooth + wave * std::sin(kTurn * p_mm / period_mm + phase_rad);
  }
};

/// The six errors of one axis, components along and about x, y, z. For the x axis:
/// translation = EXX (position), EYX, EZX (straightness); rotation = EAX, EBX, ECX.
struct AxisErrors {
  std::array<ErrorCurve, 3> translation;
  std::array<ErrorCurve, 3> rotation;
};

/// The 21 parametric errors of three linear axes, in the notation of ISO 230-1:2012.
struct GeometricErrors {
  std::array<AxisErrors, 3> axes;  ///< x, y, z.
  double squareness_xy_rad = 0.0;  ///< Excess of the angle from +x to +y over 90 deg.
  double squareness_xz_rad = 0.0;  ///< Excess of the angle from +x to +z over 90 deg.
  double squareness_yz_rad = 0.0;  ///< Excess of the angle from +y to +z over 90 deg.
  /// From the point of the ram about which the z axis rotates to the tip centre: the lever of the
  /// rotations of the z axis.
  Eigen::Vector3d tip_offset_mm = Eigen::Vector3d::Zero();
};

/// True tip position minus scale reading, at a reading: the 21 parametric errors of a bridge
/// machine whose y axis carries x, which carries z, which carries the probe. Rigid bodies, small
/// angles:
///   e = sum over the axes k of  t_k + r_k x L_k  +  squareness,
///   q = reading - tip offset (positions of the axes),
///   L_z = tip offset, L_x = L_z + (0, 0, q_z), L_y = L_x + (q_x, 0, 0).
/// With axes that are not square, x the reference:
///   (-xy q_y - xz q_z,  -yz q_z,  0).
/// Sources: ISO 230-1:2012 (names and signs); G. Zhang et al., "Error compensation of coordinate
/// measuring machines", CIRP Annals 34(1), 1985; H. Schwenk et al., "Geometric error measurement
/// and compensation of machines - an update", CIRP Annals 57(2), 2008.
[[nodiscard]] inline Eigen::Vector3d geometric_error_mm(const GeometricErrors& errors,
                                                        const Eigen::Vector3d& reading_W_mm) {
  const auto values = [](const std::array<ErrorCurve, 3>& curves, double p_mm) {
    return Eigen::Vector3d(curves[0].at(p_mm), curves[1].at(p_mm), curves[2].at(p_mm));
  };
  const Eigen::Vector3d q = reading_W_mm - errors.tip_offset_mm;
  const Eigen::Vector3d lever_z = errors.tip_offset_mm;
  const Eigen::Vector3d lever_x = lever_z + Eigen::Vector3d(0.0, 0.0, q.z());
  const Eigen::Vector3d lever_y = lever_x + Eigen::Vector3d(q.x(), 0.0, 0.0);
  const std::array<Eigen::Vector3d, 3> levers = {lever_x, lever_y, lever_z};
  Eigen::Vector3d e(-errors.squareness_xy_rad * q.y() - errors.squareness_xz_rad * q.z(),
                    -errors.squareness_yz_rad * q.z(), 0.0);
  for (int k = 0; k < 3; ++k) {
    const AxisErrors& axis = errors.axes[static_cast<std::size_t>(k)];
    e += values(axis.translation, q[k]) +
         values(axis.rotation, q[k]).cross(levers[static_cast<std::size_t>(k)]);
  }
  return e;
}

/// One harmonic of the pre-travel: amplitude cos(order phi + phase), phi the azimuth of the
/// approach.
struct PretravelLobe {
  int order = 3;
  double amplitude_mm = 0.0;
  double phase_rad = 0.0;
};

/// A cantilever of circular section bent by the trigger force: 64 F L^3 / (3 pi E D^4).
struct StylusShaft {
  double length_mm = 0.0;
  double diameter_mm = 1.0;
  double modulus_MPa = 600e3;  ///< Tungsten carbide.
  double force_N = 0.0;        ///< Trigger force.

  [[nodiscard]] double deflection_mm() const {
    constexpr double kPi = 3.141592653589793;
    return 64.0 * force_N * std::pow(length_mm, 3) /
           (3.0 * kPi * modulus_MPa * std::pow(diameter_mm, 4));
  }
};

/// Hidden errors of a simulated machine and probe. All zero: ideal.
struct MachineErrors {
  double repeatability_mm = 0.0;  ///< Standard deviation of a touch along its approach direction.
  double tip_radius_error_mm = 0.0;  ///< Real minus nominal radius of the ball.
  GeometricErrors geometry;
  double pretravel_mm = 0.0;    ///< Mean travel across the stylus from contact to trigger.
  double pretravel_z_mm = 0.0;  ///< Mean travel along the stylus.
  std::vector<PretravelLobe> pretravel_lobes;
  StylusShaft stylus;
  /// Reading approached from below minus reading from above, each axis.
  Eigen::Vector3d backlash_mm = Eigen::Vector3d::Zero();
  double scale_expansion_1_K = 0.0;      ///< Expansion coefficient of the scales.
  double scale_temperature_degC = 20.0;  ///< True value, which is also the reading.
  Eigen::Vector3d drift_mm =
      Eigen::Vector3d::Zero();   ///< Final drift of the readings of a fixed point.
  double drift_time_s = 3600.0;  ///< Time constant of the drift, > 0.
};

/// Positions of the points of a simulated scan: a real machine keeps the requested step only on
/// average. All zero: even steps from the commanded start on.
struct ScanScatter {
  double start_rad = 0.0;      ///< Largest offset of the first point from the start; uniform.
  double step_1 = 0.0;         ///< Largest relative change of a step; uniform.
  double dropped_share = 0.0;  ///< Share of the points that are missing, 0..1.

  [[nodiscard]] bool even() const {
    return start_rad == 0.0 && step_1 == 0.0 && dropped_share == 0.0;
  }
};

/// Hidden thermal expansion of, and dust on, a simulated part.
struct PartErrors {
  double expansion_1_K = 0.0;
  double dust_share = 0.0;  ///< Share of the touches that meet a particle, 0..1.
  double dust_mm = 0.0;     ///< Thickness of the largest particle; uniform from 0.
};

}  // namespace rondure::cmm
