#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Least and largest squared distance [mm^2].
struct ScanExtremes {
  double low = 0.0;
  double high = 0.0;
  bool finite = true;  ///< false: a coordinate is not finite, and `low` and `high` are invalid.
};

/// Finds the extreme squared distances of all points from an axis or a centre in one pass: S1, the
/// unit in which the speed of the fits is stated. Points are taken relative to the axis point or
/// centre first, so that sets far from the origin keep their digits. Four points at a time with
/// AVX2, else one; same bits on every processor. Allocates nothing.
[[nodiscard]] ScanExtremes scan(SpacePoints points_mm, const Axis& axis);
[[nodiscard]] ScanExtremes scan(SpacePoints points_mm, const Eigen::Vector3d& center_mm);
[[nodiscard]] ScanExtremes scan(PlanePoints points_mm, const Eigen::Vector2d& center_mm);

/// The extreme squared distances of consecutive blocks of points [mm^2].
struct BlockScan {
  std::size_t block = 1;    ///< Points per block, >= 1; the last block may be shorter.
  std::vector<double> low;  ///< One number per block; the memory is kept between calls.
  std::vector<double> high;
  ScanExtremes all;
};

/// Runs scan() block by block.
/// @param out  `block` is read, the rest is written.
void scan_blocks(SpacePoints points_mm, const Axis& axis, BlockScan& out);
void scan_blocks(SpacePoints points_mm, const Eigen::Vector3d& center_mm, BlockScan& out);
void scan_blocks(PlanePoints points_mm, const Eigen::Vector2d& center_mm, BlockScan& out);

/// Returns the first point whose squared distance is exactly `square_mm2`, as scan_blocks() found
/// it, or the number of points if there is none.
[[nodiscard]] std::size_t find_square(SpacePoints points_mm, const Axis& axis, double square_mm2);
[[nodiscard]] std::size_t find_square(SpacePoints points_mm, const Eigen::Vector3d& center_mm,
                                      double square_mm2);
[[nodiscard]] std::size_t find_square(PlanePoints points_mm, const Eigen::Vector2d& center_mm,
                                      double square_mm2);

}  // namespace rondure::fit
