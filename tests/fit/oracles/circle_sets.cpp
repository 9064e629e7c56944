#include "circle_sets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::test {
namespace {

constexpr double kRadius = 25.0;

Eigen::Vector2d polar(double radius_mm, double angle_rad) {
  return {radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad)};
}

Points2 around(int n, double turn_rad, double form_mm, core::KeyedNoise& noise) {
  const double start = core::kTwoPi * noise.uniform();
  Points2 points;
  for (int k = 0; k < n; ++k) {
    const double angle = start + turn_rad * (k + 0.6 * noise.uniform()) / n;
    points.push_back(polar(kRadius + form_mm * noise.normal(), angle));
  }
  return points;
}

Points2 cocircular(int n, core::KeyedNoise& noise) {
  constexpr std::array<std::array<int, 2>, 5> kSums = {
      {{7, 24}, {15, 20}, {20, 15}, {24, 7}, {25, 0}}};
  Points2 points;
  while (static_cast<int>(points.size()) < n) {
    const auto& [a, b] = kSums[static_cast<std::size_t>(5.0 * noise.uniform())];
    points.emplace_back(noise.uniform() < 0.5 ? -a : a, noise.uniform() < 0.5 ? -b : b);
    if (noise.uniform() < 0.5)
      points.back() = Eigen::Vector2d(points.back().y(), points.back().x());
    if (std::count(points.begin(), points.end(), points.back()) > 1) points.pop_back();
  }
  const int moved = static_cast<int>(4.0 * noise.uniform());
  for (int k = 0; k < moved; ++k) points[static_cast<std::size_t>(k)].x() += 1e-3;
  return points;
}

Points2 paired(int n, bool same, core::KeyedNoise& noise) {
  Points2 points = around((n + 1) / 2, core::kTwoPi, 0.01, noise);
  if (points.size() < 3) points = around(3, core::kTwoPi, 0.01, noise);
  for (std::size_t k = 0; static_cast<int>(points.size()) < n; ++k) {
    const double longer = same ? 1.0 : 1.0 + 4e-4 * noise.normal();
    points.push_back(longer * points[k]);
  }
  return points;
}

}  // namespace

std::string name_of(Hard kind) {
  static const std::array<const char*, kHardKinds> kNames = {
      "full circle", "arc", "lattice", "duplicates", "spokes", "co-circular", "symmetric", "cloud"};
  return kNames[static_cast<std::size_t>(kind)];
}

Points2 hard_set(Hard kind, int n, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {71, static_cast<std::uint64_t>(kind)});
  const double form_mm = kRadius * std::pow(10.0, -5.0 + 3.0 * noise.uniform());
  Points2 points;
  switch (kind) {
    case Hard::kFullCircle:
      return around(n, core::kTwoPi, form_mm, noise);
    case Hard::kArc:
      return around(n, (60.0 + 120.0 * noise.uniform()) * core::kDegree, 0.1 * form_mm, noise);
    case Hard::kLattice:
      points = around(n, core::kTwoPi, 0.002, noise);
      for (auto& p : points) p = (p * 1e3).array().round() * 1e-3;
      return points;
    case Hard::kDuplicates:
      return paired(n, true, noise);
    case Hard::kSpokes:
      return paired(n, false, noise);
    case Hard::kCocircular:
      return cocircular(std::min(n, 16), noise);  // of 20 places
    case Hard::kSymmetric:
      for (int k = 0; k < n; ++k) {
        points.push_back(polar(kRadius + (k % 2 == 0 ? form_mm : 0.0), core::kTwoPi * k / n));
      }
      return points;
    case Hard::kCloud:
      for (int k = 0; k < n; ++k)
        points.emplace_back(50.0 * noise.uniform(), 50.0 * noise.uniform());
      return points;
  }
  return points;
}

Hard kind_of(std::uint64_t seed) { return static_cast<Hard>(seed % kHardKinds); }

Points2 hard_set(std::uint64_t seed, int low, int high) {
  const auto span = static_cast<std::uint64_t>(high - low + 1);
  return hard_set(kind_of(seed), low + static_cast<int>(seed / kHardKinds % span), seed);
}

}  // namespace rondure::test
