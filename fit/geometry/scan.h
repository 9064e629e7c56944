#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/axis.h"

namespace rondure::fit {

/// Least and largest squared distance [mm^2].
struct ScanExtremes {
  double low = 0.0;
  double high = 0.0;
  bool finite = true;  ///< false: a coordinate is not a finite number; the others mean nothing.
};

/// One pass over all points: their extreme distances from an axis or a centre. This is S1, the unit
/// in which the speed of the fits is stated.
///
/// Points are taken relative to the axis point (the centre) first, so that sets far from the origin
/// keep their digits. Four points at a time where the processor has AVX2, which is asked at run
/// time; the same operations in the same order for each point, so the same bits everywhere. Reads
/// memory once, allocates nothing.
[[nodiscard]] ScanExtremes scan(std::span<const Eigen::Vector3d> points_mm, const Axis& axis);
[[nodiscard]] ScanExtremes scan(std::span<const Eigen::Vector3d> points_mm,
                                const Eigen::Vector3d& center_mm);
[[nodiscard]] ScanExtremes scan(std::span<const Eigen::Vector2d> points_mm,
                                const Eigen::Vector2d& center_mm);

/// What a pass that looks at blocks of points keeps: the squared extremes of each.
struct BlockScan {
  std::size_t block = 1;    ///< Points a block; the last one may be shorter.
  std::vector<double> low;  ///< One number a block; the memory is kept between calls.
  std::vector<double> high;
  ScanExtremes all;
};

/// scan() block by block. @param out  `block` is read, the rest is written.
void scan_blocks(std::span<const Eigen::Vector3d> points_mm, const Axis& axis, BlockScan& out);
void scan_blocks(std::span<const Eigen::Vector3d> points_mm, const Eigen::Vector3d& center_mm,
                 BlockScan& out);
void scan_blocks(std::span<const Eigen::Vector2d> points_mm, const Eigen::Vector2d& center_mm,
                 BlockScan& out);

/// The first point whose squared distance is exactly `square_mm2`, as scan_blocks() found it;
/// the number of points when there is none.
[[nodiscard]] std::size_t find_square(std::span<const Eigen::Vector3d> points_mm, const Axis& axis,
                                      double square_mm2);
[[nodiscard]] std::size_t find_square(std::span<const Eigen::Vector3d> points_mm,
                                      const Eigen::Vector3d& center_mm, double square_mm2);
[[nodiscard]] std::size_t find_square(std::span<const Eigen::Vector2d> points_mm,
                                      const Eigen::Vector2d& center_mm, double square_mm2);

}  // namespace rondure::fit
