#include "fit/least_squares/line.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;
using Wide3 = Eigen::Matrix<long double, 3, 1>;

Points3 line_points(std::size_t n, const Axis& axis, double length, double scatter,
                    std::uint64_t seed) {
  core::KeyedNoise noise(seed, {41});
  Points3 out;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(axis.point_mm + axis.direction * length * (noise.uniform() - 0.5) +
                  scatter * Eigen::Vector3d(noise.normal(), noise.normal(), noise.normal()));
  }
  return out;
}

Axis some_axis(std::uint64_t seed, double place) {
  core::KeyedNoise noise(seed, {42});
  const Eigen::Vector3d direction(noise.normal(), noise.normal(), noise.normal());
  return {place * Eigen::Vector3d(1.0, -1.0, 1.0), direction.normalized()};
}

TEST(LsLine, ResidualsNeitherShiftNorTurnIt) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Axis axis = some_axis(seed, 100.0);
    const Points3 points =
        line_points(3 + seed % 40, axis, 200.0, seed % 3 == 0 ? 20.0 : 1e-3, seed);
    const auto line = ls_line(points);
    ASSERT_TRUE(line.has_value()) << line.error().what;
    const Wide3 t = line->axis.direction.cast<long double>();
    Wide3 shift = Wide3::Zero();
    Wide3 turn = Wide3::Zero();
    double farthest = 0.0;
    double squares = 0.0;
    for (const auto& p : points) {
      const Wide3 v = p.cast<long double>() - line->axis.point_mm.cast<long double>();
      const Wide3 residual = v - t * (v.dot(t) / t.squaredNorm());
      shift += residual;
      turn += residual * v.dot(t);
      const double r = distance_mm(line->axis, p);
      farthest = std::max(farthest, r);
      squares += r * r;
    }
    const auto n = static_cast<double>(points.size());
    EXPECT_LT(static_cast<double>(shift.norm()) / n, 1e-12);
    EXPECT_LT(static_cast<double>(turn.norm()) / n, 2e-12 * 100.0);
    EXPECT_NEAR(line->deviation_mm, 2.0 * farthest, 1e-12);
    EXPECT_NEAR(line->rms_mm, std::sqrt(squares / n), 1e-12);
  }
}

TEST(LsLine, HasNoNeighbourWithLessSquares) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = line_points(30, some_axis(seed, 5.0), 50.0, 3.0, seed);
    const auto line = ls_line(points);
    ASSERT_TRUE(line.has_value());
    core::KeyedNoise noise(seed, {43});
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector3d turn(noise.normal(), noise.normal(), noise.normal());
      const Axis other{line->axis.point_mm, (line->axis.direction + 0.3 * turn).normalized()};
      double squares = 0.0;
      for (const auto& p : points) squares += std::pow(distance_mm(other, p), 2);
      EXPECT_GE(std::sqrt(squares / 30.0), line->rms_mm);
    }
  }
}

TEST(LsLine, KeepsItsDigitsFarFromTheOrigin) {
  const Axis axis = some_axis(7, 1e6);
  const auto line = ls_line(line_points(1000, axis, 1000.0, 0.0, 7));
  ASSERT_TRUE(line.has_value());
  EXPECT_LT(distance_mm(axis, line->axis.point_mm), 1e-9);  // points are stored to 1e-10
  EXPECT_LT(line->axis.direction.cross(axis.direction).norm(), 1e-12);
  EXPECT_LT(line->deviation_mm, 1e-9);
}

TEST(LsLine, RefusesWhatFixesNoLine) {
  EXPECT_EQ(ls_line({}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(ls_line(Points3{{1, 2, 3}, {1, 2, 3}}).error().code, core::Code::kTooFewPoints);
  EXPECT_EQ(ls_line(Points3{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}).error().code,
            core::Code::kRank);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ls_line(Points3{{1, 0, 0}, {nan, 0, 0}}).error().code, core::Code::kNotFinite);
}

TEST(MedianLine, StraightnessIsTwiceTheLargestDistanceFromTheLine) {
  // A bow of 3 um: about the mean line the ends and the middle stand off by 1 and 2 um.
  const Points3 bow = {{0.0, 0.0, 0.0}, {0.003, 0.0, 50.0}, {0.0, 0.0, 100.0}};
  const auto straightness = median_line_straightness(bow);
  ASSERT_TRUE(straightness.has_value());
  EXPECT_NEAR(straightness->deviation_mm, 2.0 * 0.002, 1e-12);
  EXPECT_NEAR(straightness->axis.direction.z(), 1.0, 1e-12);
  EXPECT_EQ(median_line_straightness(Points3{{0, 0, 0}, {0, 0, 1}}).error().code,
            core::Code::kTooFewPoints);
}

}  // namespace
}  // namespace rondure::fit
