#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

#include "fit/geometry/frames.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/internal/gauss_newton.h"

namespace rondure::fit {

/// Instruction sets of the loops over all points. All give the same bits.
enum class Simd { kPortable, kAvx2, kAvx512 };

/// The best instruction set of this processor.
[[nodiscard]] Simd best_simd();

/// Extreme distances of consecutive stretches of the points. After a small move of the axis, only
/// stretches near an extreme have to be searched again.
class StretchExtremes {
 public:
  static constexpr std::size_t kStretches = 1024;

  /// For n points, with no extremes yet.
  explicit StretchExtremes(std::size_t n);
  /// Adds the extremes of a block of points that begins with point `first` [mm].
  void add(std::size_t first, double low_mm, double high_mm);

  /// Points per stretch; stretch i holds the points [i size, (i + 1) size), cut at n.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether stretch i can hold an extreme after distances have changed by `change_mm` at most.
  [[nodiscard]] bool may_hold(std::size_t i, double change_mm) const;

 private:
  std::size_t size_;
  std::array<double, kStretches> low_mm_, high_mm_;
  double lowest_mm_ = std::numeric_limits<double>::infinity();
  double highest_mm_ = 0.0;
};

/// Finds the least and largest of `distance_mm(i)` for i < n. With `extremes`, searches only the
/// stretches that can hold them after distances have changed by `change_mm` at most.
template <class Distance>
[[nodiscard]] Extremes distance_range(std::size_t n, const Distance& distance_mm,
                                      const StretchExtremes* extremes = nullptr,
                                      double change_mm = 0.0) {
  Extremes out;
  const std::size_t size = extremes == nullptr ? n : extremes->size();
  for (std::size_t first = 0; first < n; first += size) {
    if (extremes != nullptr && !extremes->may_hold(first / size, change_mm)) continue;
    for (std::size_t i = first; i < std::min(n, first + size); ++i) out.take(distance_mm(i));
  }
  return out;
}

/// Results of a pass over the points.
template <int N>
struct PassSums : NormalSums<N> {
  double along_mm = 0.0;  ///< Mean position of the points along the axis, from the origin [mm].
  /// Mean of the unit vectors from the axis to the points, times the radius [mm]; equals the mean
  /// of the points across the axis except for their form. With matrix only.
  Eigen::Vector2d across_mm = Eigen::Vector2d::Zero();
  double lever = 0.0;  ///< A tilt moves a point by at most this times the move x; with matrix only.
};

/// Settings of a pass.
struct PassOptions {
  bool matrix = true;                   ///< Otherwise the matrix stays zero.
  StretchExtremes* extremes = nullptr;  ///< Receives the extreme distances, unless null.
  Simd simd = best_simd();
};

/// Gauss-Newton sums of the radial distances about a cylinder, in the unknowns of CylinderFrame and
/// the radius: gradient (frame.row(p), -1).
///
/// Points within 0.2 % of the radius need no square root or division: the binomial series takes
/// their place, and the matrix, but not the right side, uses the position of a point in radii for
/// its unit vector. Blocks of 1024 points are summed pairwise. A coordinate that is not finite
/// makes `squares` not finite; a radius that is not positive makes it infinite.
///
/// @param origin_mm  Origin to which `frame` is relative.
[[nodiscard]] PassSums<5> cylinder_sums(SpacePoints points_mm, const Eigen::Vector3d& origin_mm,
                                        const CylinderFrame& frame, double radius_mm,
                                        const PassOptions& options = {});

/// The same sums about a circle, in the unknowns centre and radius. The centre is relative to the
/// origin.
[[nodiscard]] PassSums<3> circle_sums(PlanePoints points_mm, const Eigen::Vector2d& origin_mm,
                                      const Eigen::Vector2d& center_mm, double radius_mm,
                                      const PassOptions& options = {});

}  // namespace rondure::fit
