#pragma once

// Points of the method specification, cylindricity sections 12.2 and 13, and helpers for seeded
// sets.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/axis.h"

namespace rondure::test {

inline double spec_radius(char surface, double form_um, double theta, double z) {
  const double q = 2.0 * z / 80.0;
  const double b = q * q - 1.0 / 3.0;
  double v = 0.0;
  double s = 2.9;
  switch (surface) {
    case 'A':
      v = std::cos(2 * theta + 0.3 + 0.5 * q) + 0.6 * std::cos(3 * theta + 1.1 - 0.4 * q) +
          0.4 * std::cos(5 * theta + 2.0);
      s = 3.4;
      break;
    case 'B':
      v = 0.6 * q + 0.9 * b + 0.4 * std::cos(2 * theta + 1.0) + 0.3 * std::cos(4 * theta + 0.2);
      break;
    default:
      v = 1.2 * b * std::cos(theta + 0.7) + 0.5 * std::cos(3 * theta + 2.2 + q) + 0.2 * q +
          0.2 * std::cos(7 * theta);
  }
  return 25.0 + form_um * 1e-3 * v / s;
}

/// Tilt of the surfaces A, B, C: angle and direction in degrees.
inline Eigen::Matrix3d spec_tilt(char surface) {
  const double tilt = (surface == 'A' ? 3.7 : surface == 'B' ? 11.3 : 18.9) * core::kDegree;
  const double psi = (surface == 'A' ? 20.0 : surface == 'B' ? 137.0 : 251.0) * core::kDegree;
  return Eigen::AngleAxisd(tilt, Eigen::Vector3d(-std::sin(psi), std::cos(psi), 0.0))
      .toRotationMatrix();
}

/// The plain splitmix64 sequence that section 12.2 prescribes: one state, two draws per point.
class SpecNoise {
 public:
  explicit SpecNoise(std::uint64_t seed) : state_(seed) {}
  double normal() {
    const double u1 = uniform();
    const double u2 = uniform();
    return std::sqrt(-2.0 * std::log(1.0 - u1)) * std::cos(core::kTwoPi * u2);
  }

 private:
  double uniform() { return static_cast<double>(core::splitmix64(state_) >> 11U) * 0x1.0p-53; }
  std::uint64_t state_;
};

/// The 28 points of a case: layer-major, four layers of seven.
inline std::vector<Eigen::Vector3d> spec_points(char surface, int form_um, int sigma_um) {
  SpecNoise noise(static_cast<std::uint64_t>(1000 * sigma_um + form_um));
  const Eigen::Matrix3d tilt = spec_tilt(surface);
  std::vector<Eigen::Vector3d> points;
  for (int layer = 0; layer < 4; ++layer) {
    const double z = -35.0 + 70.0 * layer / 3.0;
    for (int k = 0; k < 7; ++k) {
      const double theta = core::kTwoPi * k / 7.0;
      const double r = spec_radius(surface, form_um, theta, z) + sigma_um * 1e-3 * noise.normal();
      points.emplace_back(tilt * Eigen::Vector3d(r * std::cos(theta), r * std::sin(theta), z));
    }
  }
  return points;
}

/// A random vector from a cube of half side `size`.
inline Eigen::Vector3d draw(core::KeyedNoise& random, double size) {
  const double x = size * (2.0 * random.uniform() - 1.0);
  const double y = size * (2.0 * random.uniform() - 1.0);
  return {x, y, size * (2.0 * random.uniform() - 1.0)};
}

/// Settings of random_cylinder(): layers of radius 25 mm about z, bent towards x.
struct CylinderKind {
  int layers = 4;
  int points = 7;
  double half_length_mm = 35.0;
  double noise_mm = 0.003;
  double arc_deg = 360.0;
  double bend_mm = 0.0;
};

/// @param stream  Stream of random numbers: another stream gives other points for the same seed.
inline std::vector<Eigen::Vector3d> random_cylinder(std::uint64_t seed, std::uint64_t stream,
                                                    const CylinderKind& kind) {
  core::KeyedNoise noise(seed, {stream});
  std::vector<Eigen::Vector3d> points;
  for (int j = 0; j < kind.layers; ++j) {
    for (int k = 0; k < kind.points; ++k) {
      const double theta = kind.arc_deg * core::kDegree * (k + 0.4 * noise.uniform()) / kind.points;
      const double u = 2.0 * j / (kind.layers - 1) - 1.0;
      const double r = 25.0 + kind.noise_mm * noise.normal();
      points.emplace_back(r * std::cos(theta) + kind.bend_mm * u * u, r * std::sin(theta),
                          kind.half_length_mm * u);
    }
  }
  return points;
}

/// Width of the zone of the points about an axis [mm].
inline double zone_about(const std::vector<Eigen::Vector3d>& points, const fit::Axis& axis) {
  double low = 1e300;
  double high = 0.0;
  for (const auto& p : points) {
    low = std::min(low, fit::distance_mm(axis, p));
    high = std::max(high, fit::distance_mm(axis, p));
  }
  return high - low;
}

inline std::vector<Eigen::Vector2d> flat(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector2d> out;
  for (const auto& p : points) out.emplace_back(p.head<2>());
  return out;
}

}  // namespace rondure::test
