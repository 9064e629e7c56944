#pragma once

// Small and hard plane sections for the circle oracles.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace rondure::test {

using Points2 = std::vector<Eigen::Vector2d>;
using Points3 = std::vector<Eigen::Vector3d>;

/// Properties that make a set hard.
enum class Hard {
  kFullCircle,  ///< jittered angles over the whole turn
  kArc,         ///< 60 to 180 deg
  kLattice,     ///< rounded to 1 um: ties
  kDuplicates,  ///< every point at least twice
  kSpokes,      ///< pairs of points on the same ray
  kCocircular,  ///< exactly on one circle (Pythagorean), up to three of them moved by 1 um
  kSymmetric,   ///< a regular polygon with two alternating radii
  kCloud,       ///< no circle at all: a square filled at random
};
inline constexpr int kHardKinds = 8;

[[nodiscard]] std::string name_of(Hard kind);

/// `n` points of the kind, n >= 4; co-circular sets have 16 at most. Same seed, same points.
[[nodiscard]] Points2 hard_set(Hard kind, int n, std::uint64_t seed);

/// The seed-th set of a seeded loop: kinds in turn, n in low..high in turn.
[[nodiscard]] Points2 hard_set(std::uint64_t seed, int low, int high);
[[nodiscard]] Hard kind_of(std::uint64_t seed);

}  // namespace rondure::test
