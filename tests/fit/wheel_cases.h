#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"
#include "tests/fit/specified_normals.h"

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

/// The wheel of the worked cases W-1 to W-3: points, and the axis as stated.
struct SpecifiedWheel {
  static constexpr double kRadius_mm = 49.9832;
  static constexpr double kPoint_mm = 0.4e-3;
  static constexpr double kAxis_mm = 0.5e-3;
  Points2 points_mm;
  Points2 true_points_mm;  ///< Without noise.
  Eigen::Vector2d axis_mm = Eigen::Vector2d::Zero();
  Eigen::Vector2d true_axis_mm = {12.004, -7.0};
};

/// @param degrees  Angles of the points.
/// @param proud_row  A point 45 um proud.
inline SpecifiedWheel specified_wheel(std::uint64_t seed, std::span<const double> degrees,
                                      std::optional<std::size_t> proud_row = std::nullopt) {
  SpecifiedNormals normals(seed);
  SpecifiedWheel out;
  const auto direction = [](double deg) {
    return Eigen::Vector2d(std::cos(deg * core::kDegree), std::sin(deg * core::kDegree));
  };
  const Eigen::Vector2d center = out.true_axis_mm + 5e-3 * direction(215.0);
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    const double deg = degrees[i];
    double r = SpecifiedWheel::kRadius_mm + 1.2e-3 * std::cos((2.0 * deg - 40.0) * core::kDegree) +
               0.8e-3 * std::cos((3.0 * deg + 75.0) * core::kDegree);
    if (proud_row && *proud_row == i) r += 45e-3;
    out.true_points_mm.emplace_back(center + r * direction(deg));
    out.points_mm.emplace_back(center +
                               (r + SpecifiedWheel::kPoint_mm * normals.next()) * direction(deg));
  }
  const double x = normals.next();
  const double z = normals.next();
  out.axis_mm = out.true_axis_mm + SpecifiedWheel::kAxis_mm * Eigen::Vector2d(x, z);
  return out;
}

/// n angles from a first one, a step apart [deg].
inline std::vector<double> even_degrees(std::size_t n, double from_deg, double step_deg) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(from_deg + step_deg * static_cast<double>(i));
  return out;
}

}  // namespace rondure::test
