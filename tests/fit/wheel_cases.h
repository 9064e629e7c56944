#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::test {

using Points2 = std::vector<Eigen::Vector2d>;

/// Points of worked example 1 (tests/data/spec_wheel/example1.csv).
inline Points2 example_1() {
  return {{61.242357, 1.682756},   {40.678248, 33.956783},   {3.317070, 42.243342},
          {-28.957602, 21.678822}, {-37.238418, -15.682062}, {-16.679395, -47.958421},
          {20.681888, -56.237433}, {52.957602, -35.678822}};
}

/// Points of worked example 2 (tests/data/spec_wheel/example2.csv).
inline Points2 example_2() {
  return {{75.231403, 6.788151},   {61.946449, 43.275267},   {32.200115, 68.231116},
          {-6.037826, 74.977697},  {-42.556323, 61.740802},  {-67.483029, 31.951007},
          {-74.223764, -6.287482}, {-60.948998, -42.777052}, {-31.203289, -67.737922},
          {7.037669, -74.475903},  {43.523754, -61.194289},  {68.486128, -31.452452}};
}

/// n evenly spaced points over an arc of a circle, both ends included unless the arc is the whole
/// circle.
inline Points2 arc_points(std::size_t n, double arc_deg, double radius, double sigma,
                          std::uint64_t seed, const Eigen::Vector2d& center = {0.0, 0.0}) {
  core::KeyedNoise noise(seed, {77});
  const double parts = arc_deg >= 360.0 ? static_cast<double>(n) : static_cast<double>(n - 1);
  Points2 out;
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = arc_deg * core::kDegree * static_cast<double>(i) / parts;
    const double r = radius + sigma * noise.normal();
    out.emplace_back(center + r * Eigen::Vector2d(std::cos(theta), std::sin(theta)));
  }
  return out;
}

}  // namespace rondure::test
