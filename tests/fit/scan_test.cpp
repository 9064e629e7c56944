#include "fit/geometry/scan.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"

namespace rondure::fit {
namespace {

template <class Point>
std::vector<Point> cloud(std::uint64_t seed, std::size_t count, double offset) {
  core::KeyedNoise noise(seed, {77});
  std::vector<Point> out(count);
  for (Point& p : out) {
    for (auto& coordinate : p) coordinate = offset + 50.0 * noise.normal();
  }
  return out;
}

/// The contract of the scan, word by word: relative to the origin, then the sums from left to
/// right.
double square(const Eigen::Vector3d& p, const Axis& axis) {
  const auto frame = across(axis.direction);
  const double x = p[0] - axis.point_mm[0];
  const double y = p[1] - axis.point_mm[1];
  const double z = p[2] - axis.point_mm[2];
  const double a = x * frame(0, 0) + y * frame(1, 0) + z * frame(2, 0);
  const double b = x * frame(0, 1) + y * frame(1, 1) + z * frame(2, 1);
  return a * a + b * b;
}
double square(const Eigen::Vector3d& p, const Eigen::Vector3d& c) {
  return (p[0] - c[0]) * (p[0] - c[0]) + (p[1] - c[1]) * (p[1] - c[1]) +
         (p[2] - c[2]) * (p[2] - c[2]);
}
double square(const Eigen::Vector2d& p, const Eigen::Vector2d& c) {
  return (p[0] - c[0]) * (p[0] - c[0]) + (p[1] - c[1]) * (p[1] - c[1]);
}

template <class Point, class Place>
void expect_same_bits(const std::vector<Point>& points, const Place& place) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const Point& p : points) {
    low = std::min(low, square(p, place));
    high = std::max(high, square(p, place));
  }
  const ScanExtremes found = scan(std::span<const Point>(points), place);
  EXPECT_EQ(found.low, low);
  EXPECT_EQ(found.high, high);
  EXPECT_TRUE(found.finite);
}

TEST(Scan, GivesTheBitsOfOnePointAfterTheOtherWhateverTheNumber) {
  for (std::size_t count = 1; count <= 70; ++count) {
    SCOPED_TRACE(count);
    for (const double offset : {0.0, 1e6}) {
      const auto space = cloud<Eigen::Vector3d>(count, count, offset);
      const auto plane = cloud<Eigen::Vector2d>(count, count, offset);
      const Axis axis{Eigen::Vector3d::Constant(offset + 1.25),
                      Eigen::Vector3d(0.3, -0.2, 0.9).normalized()};
      expect_same_bits(space, axis);
      expect_same_bits(space, Eigen::Vector3d(Eigen::Vector3d::Constant(offset - 0.5)));
      expect_same_bits(plane, Eigen::Vector2d(Eigen::Vector2d::Constant(offset + 0.1)));
    }
  }
}

TEST(Scan, ByBlocksFindsTheExtremesOfEachBlock) {
  const auto points = cloud<Eigen::Vector3d>(5, 1003, 10.0);
  const Axis axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitY()};
  BlockScan blocks;
  for (const std::size_t size : {std::size_t{1}, std::size_t{32}, std::size_t{128}}) {
    blocks.block = size;
    scan_blocks(points, axis, blocks);
    ASSERT_EQ(blocks.low.size(), (points.size() + size - 1) / size);
    for (std::size_t k = 0; k < blocks.low.size(); ++k) {
      const auto part = std::span<const Eigen::Vector3d>(points).subspan(
          k * size, std::min(size, points.size() - k * size));
      EXPECT_EQ(blocks.low[k], scan(part, axis).low);
      EXPECT_EQ(blocks.high[k], scan(part, axis).high);
      EXPECT_EQ(square(part[find_square(part, axis, blocks.high[k])], axis), blocks.high[k]);
      EXPECT_EQ(find_square(part, axis, -1.0), part.size());
    }
    EXPECT_EQ(blocks.all.low, scan(std::span<const Eigen::Vector3d>(points), axis).low);
    EXPECT_EQ(blocks.all.high, scan(std::span<const Eigen::Vector3d>(points), axis).high);
  }
}

TEST(Scan, TellsACoordinateThatIsNotANumberWhereverItStands) {
  const Axis axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (std::size_t at = 0; at < 21; ++at) {
      auto points = cloud<Eigen::Vector3d>(3, 21, 0.0);
      points[at][at % 3] = bad;
      EXPECT_FALSE(scan(std::span<const Eigen::Vector3d>(points), axis).finite) << at;
    }
  }
}

}  // namespace
}  // namespace rondure::fit
