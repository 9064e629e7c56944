#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

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
  double squareness_xy_rad = 0.0;  ///< The angle from +x to +y is 90 deg plus this.
  double squareness_xz_rad = 0.0;  ///< From +x to +z.
  double squareness_yz_rad = 0.0;  ///< From +y to +z.
  /// From the point of the ram about which the z axis turns to the tip centre: the lever of the
  /// rotations of the z axis.
  Eigen::Vector3d tip_offset_mm = Eigen::Vector3d::Zero();
};

/// One harmonic of the pre-travel: amplitude cos(order phi + phase), phi the azimuth of the
/// approach.
struct PretravelLobe {
  int order = 3;
  double amplitude_mm = 0.0;
  double phase_rad = 0.0;
};

/// A cantilever of round section that the trigger force bends: 64 F L^3 / (3 pi E D^4).
struct StylusShaft {
  double length_mm = 0.0;
  double diameter_mm = 1.0;
  double modulus_MPa = 600e3;  ///< Tungsten carbide.
  double force_N = 0.0;        ///< At the trigger.

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
  double pretravel_mm = 0.0;    ///< Mean way across the stylus from contact to trigger.
  double pretravel_z_mm = 0.0;  ///< The same along the stylus.
  std::vector<PretravelLobe> pretravel_lobes;
  StylusShaft stylus;
  Eigen::Vector3d backlash_mm = Eigen::Vector3d::Zero();  ///< Reading approached from below minus
                                                          ///< from above, each axis.
  double scale_expansion_1_K = 0.0;                       ///< Of the scales.
  double scale_temperature_degC = 20.0;                   ///< Real, and as read.
  Eigen::Vector3d drift_mm =
      Eigen::Vector3d::Zero();   ///< Of the readings of a fixed point, finally.
  double drift_time_s = 3600.0;  ///< Its time constant, > 0.
};

/// Hidden thermal expansion of, and dust on, a simulated part.
struct PartErrors {
  double expansion_1_K = 0.0;
  double dust_share = 0.0;  ///< Share of the touches that meet a particle, 0..1.
  double dust_mm = 0.0;     ///< Thickness of the largest particle; uniform from 0.
};

}  // namespace rondure::cmm
