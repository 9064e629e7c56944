#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/rotary/axes.h"

// Rotary axes with known errors, and the worked example of the method specification.

namespace rondure::test {

inline constexpr double kUm = core::kMicrometre;
inline constexpr double kUrad = 1e-6;

/// Axes C about +Z and A about +X, through the origin.
inline const fit::RotaryAxis kC = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()};
inline const fit::RotaryAxis kA = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero()};
inline constexpr double kDeg45 = 45.0 * core::kDegree;

/// True (t; w) at an angle from the reference; zero at 0.
using TrueErrors = std::function<fit::Vector6(double)>;

/// Ball positions of setups (L, H) of a head that hangs down.
inline std::vector<Eigen::Vector3d> hanging(const std::vector<std::array<double, 2>>& setups) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& [l, h] : setups) out.emplace_back(0.0, h, -l);
  return out;
}

/// Rows of the equation dp = t + w x p for balls relative to the origin of the axis: [I3, -[p]x].
inline Eigen::Matrix<double, Eigen::Dynamic, 6> error_matrix(
    const std::vector<Eigen::Vector3d>& p_mm) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> out(3 * static_cast<Eigen::Index>(p_mm.size()), 6);
  for (std::size_t i = 0; i < p_mm.size(); ++i) {
    out.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << Eigen::Matrix3d::Identity(),
        -fit::cross_matrix(p_mm[i]);
  }
  return out;
}

/// Balls of the reference pose after the nominal rotation.
inline std::vector<Eigen::Vector3d> turned(const std::vector<Eigen::Vector3d>& p,
                                           const fit::RotaryAxis& axis, double angle) {
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& one : p) out.emplace_back(axis.turn(angle) * one);
  return out;
}

/// Names of balls: "a", "b", ...
inline std::vector<std::string> letters(std::size_t n) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < n; ++i) out.emplace_back(1, static_cast<char>('a' + i));
  return out;
}

/// n angles from first to last, both included.
inline std::vector<double> angles_deg(double first, double last, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back((first + (last - first) * i / (n - 1)) * core::kDegree);
  return out;
}

/// Conditions of the measurement of an axis.
struct Probing {
  double u_mm = 0.5e-3;
  std::uint64_t seed = 1;
  bool noisy = true;
  int references = 3;  ///< 0: the reference positions are exact.
};

/// Measurement of balls named "a", "b", ... at all stations.
/// @param p0_mm  Ball centres in the reference pose, relative to the origin of the axis.
inline fit::RotaryMeasurement measured(const fit::RotaryAxis& axis,
                                       const std::vector<Eigen::Vector3d>& p0_mm,
                                       const std::vector<double>& stations_rad,
                                       const TrueErrors& truth, const Probing& probing) {
  core::KeyedNoise noise(probing.seed, {5});
  const double size = probing.noisy ? probing.u_mm : 0.0;
  const auto ball = [&](std::size_t i, const Eigen::Vector3d& place, double sigma, double u) {
    const double x = sigma * noise.normal();
    const double y = sigma * noise.normal();
    const double z = sigma * noise.normal();
    return fit::BallCentre{std::string(1, static_cast<char>('a' + i)),
                           axis.origin_mm + place + Eigen::Vector3d(x, y, z),
                           Eigen::Vector3d::Constant(u)};
  };
  fit::RotaryMeasurement out;
  out.axis = axis;
  for (int r = 0; r < std::max(1, probing.references); ++r) {
    out.references.emplace_back();
    for (std::size_t i = 0; i < p0_mm.size(); ++i) {
      const bool exact = probing.references == 0;
      out.references.back().push_back(
          ball(i, p0_mm[i], exact ? 0.0 : size, exact ? 0.0 : probing.u_mm));
    }
  }
  for (const double angle : stations_rad) {
    fit::RotaryPose pose;
    pose.angle_rad = angle;
    const fit::Vector6 x = truth(angle);
    const Eigen::Isometry3d motion = fit::error_motion(x.head<3>(), x.tail<3>());
    for (std::size_t i = 0; i < p0_mm.size(); ++i)
      pose.balls.push_back(ball(i, motion * (axis.turn(angle) * p0_mm[i]), size, probing.u_mm));
    out.stations.push_back(std::move(pose));
  }
  return out;
}

/// a (cos(k phi - q) - cos q): a wave that is zero at phi = 0.
inline double wave(double phi, double a, int k, double q) {
  return a * (std::cos(k * phi - q) - std::cos(q));
}

/// Section 10: offset (12, -20) um, tilt (60, -35) urad and motion errors of the C axis.
inline fit::Vector6 example_errors(double c) {
  const Eigen::Vector3d d(12.0, -20.0, 0.0);
  const Eigen::Vector3d e(60.0, -35.0, 0.0);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(c, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  fit::Vector6 out;
  out << d - turn * d, e - turn * e;
  out(0) += wave(c, 1.5, 2, 0.3);
  out(1) += wave(c, 1.2, 2, 1.9) + wave(c, 0.4, 3, 0.0);
  out(2) += wave(c, 2.0, 1, 0.7);
  out(3) += wave(c, 5.0, 2, 0.2);
  out(4) += wave(c, 4.0, 2, -1.0);
  out(5) += wave(c, 20.0, 1, 0.5) + wave(c, 6.0, 2, 1.1);
  out.head<3>() *= kUm;
  out.tail<3>() *= kUrad;
  return out;
}

inline std::vector<Eigen::Vector3d> example_balls() {
  return hanging({{150, 50}, {150, 150}, {250, 50}});
}

inline std::vector<double> circle_of(int n) { return angles_deg(0.0, 360.0 * (n - 1) / n, n); }

/// Measurement of the worked example, section 10.
inline fit::RotaryMeasurement example(const Probing& probing) {
  return measured(kC, example_balls(), circle_of(24), example_errors, probing);
}

inline const fit::RotaryStation& station_at(const fit::RotaryStudy& study, double deg) {
  return *std::find_if(study.stations.begin(), study.stations.end(), [&](const auto& s) {
    return std::abs(s.angle_rad - deg * core::kDegree) < 1e-9;
  });
}

/// Balls spread round a part on the fixture, and errors of one of its axes.
inline std::vector<Eigen::Vector3d> five_balls() {
  return {{60, 10, 40}, {-55, 30, 100}, {-20, -65, 20}, {35, -40, 110}, {20, 65, 70}};
}

inline fit::Vector6 fixture_errors(double phi) {
  fit::Vector6 out;
  out << wave(phi, 3, 2, 0.4), wave(phi, 20, 1, 0.2), wave(phi, 15, 1, 1.0) + wave(phi, 2, 3, 0.1),
      wave(phi, 10, 1, 0.3), wave(phi, 90, 1, 0.5), wave(phi, 70, 1, -0.4);
  out.head<3>() *= kUm;
  out.tail<3>() *= kUrad;
  return out;
}

inline fit::Vector6 no_errors(double /*angle*/) { return fit::Vector6::Zero(); }

}  // namespace rondure::test
