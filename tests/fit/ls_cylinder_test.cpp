#include "fit/least_squares/cylinder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;
using Wide = long double;
using Wide3 = Eigen::Matrix<Wide, 3, 1>;
using Wide5 = Eigen::Matrix<Wide, 5, 1>;

struct Made {
  Points3 points;
  Axis axis;
  double radius = 25.0;
};

/// A lobed, barrel-shaped cylinder with noise, scanned ring by ring, somewhere in space.
Made made(std::size_t n, double radius, double form, const Eigen::Vector3d& place,
          std::uint64_t seed) {
  core::KeyedNoise noise(seed, {11});
  Made out;
  out.radius = radius;
  out.axis.direction = Eigen::Vector3d(noise.normal(), noise.normal(), noise.normal()).normalized();
  out.axis.point_mm = place;
  const auto frame = across(out.axis.direction);
  const std::size_t ring = 250;
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = core::kTwoPi * static_cast<double>(i % ring) / static_cast<double>(ring);
    const double z =
        (static_cast<double>(i / ring) + 0.5) * static_cast<double>(ring) / static_cast<double>(n) -
        0.5;
    const double r = radius + form * (0.5 * std::cos(3.0 * theta + 4.0 * z) + 2.0 * z * z +
                                      0.2 * noise.normal());
    out.points.push_back(place + frame * Eigen::Vector2d(r * std::cos(theta), r * std::sin(theta)) +
                         out.axis.direction * 3.0 * radius * z);
  }
  return out;
}

/// Gauss-Newton with the full gradient in 80-bit numbers, from the cylinder the points were made
/// of.
struct WideCylinder {
  Wide3 point, direction;
  Wide radius = 0, squares = 0;
};

Wide5 oracle_step(const Points3& points, const Wide3& origin, WideCylinder& at) {
  const Wide3 u = at.direction.unitOrthogonal();
  const Wide3 v = at.direction.cross(u);
  Eigen::Matrix<Wide, 5, 5> matrix = Eigen::Matrix<Wide, 5, 5>::Zero();
  Wide5 right = Wide5::Zero();
  at.squares = 0;
  for (const auto& p : points) {
    const Wide3 w = (p.cast<Wide>() - origin) - at.point;
    const Wide a = w.dot(u), b = w.dot(v), s = w.dot(at.direction) / at.radius;
    const Wide r = std::sqrt(a * a + b * b);
    Wide5 g;
    g << -a / r, -b / r, -s * a / r, -s * b / r, -1;
    matrix += g * g.transpose();
    right -= g * (r - at.radius);
    at.squares += (r - at.radius) * (r - at.radius);
  }
  const Wide5 step = matrix.ldlt().solve(right);
  at.point += u * step(0) + v * step(1);
  at.direction = (at.direction + (u * step(2) + v * step(3)) / at.radius).normalized();
  at.radius += step(4);
  return step;
}

/// @return The least squares with its axis relative to `origin`.
WideCylinder oracle(const Made& part, const Eigen::Vector3d& origin) {
  WideCylinder at{(part.axis.point_mm - origin).cast<Wide>(), part.axis.direction.cast<Wide>(),
                  part.radius, 0};
  for (int i = 0; i < 40; ++i) {
    if (oracle_step(part.points, origin.cast<Wide>(), at).norm() < 1e-17L * part.radius) break;
  }
  return at;
}

void expect_equal(const LsCylinder& got, const Made& part, double tolerance) {
  const Eigen::Vector3d origin = part.axis.point_mm;
  const WideCylinder want = oracle(part, origin);
  const double size = part.radius;
  EXPECT_NEAR(got.radius_mm, static_cast<double>(want.radius), tolerance * size);
  const Eigen::Vector3d direction = want.direction.cast<double>();
  EXPECT_LT(got.axis.direction.cross(direction).norm(), tolerance + 2e-16);
  // The axis point is stored with the digits its place in space leaves.
  const double storage = 4e-16 * origin.norm();
  const Axis expected{want.point.cast<double>(), direction};
  EXPECT_LT(distance_mm(expected, got.axis.point_mm - origin), tolerance * size + storage);
  EXPECT_NEAR(got.rms_mm,
              static_cast<double>(std::sqrt(want.squares / static_cast<Wide>(part.points.size()))),
              tolerance * size);
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const auto& p : part.points) {
    const double r = distance_mm(expected, p - origin);
    low = std::min(low, r);
    high = std::max(high, r);
  }
  EXPECT_NEAR(got.deviation_mm, high - low, 4.0 * tolerance * size + storage);
}

TEST(LsCylinder, IsTheFullyConvergedMinimumForSmallAndLargeSets) {
  for (const std::size_t n : {1000U, 1001U, 1250U, 20000U}) {
    for (const double share : {1e-5, 1e-3, 0.03}) {
      SCOPED_TRACE(testing::Message() << n << " points, form " << share << " R");
      const Made part = made(n, 25.0, 25.0 * share, {120.0, -340.0, 55.0}, n);
      const Eigen::Vector3d near =
          (part.axis.direction + 0.05 * Eigen::Vector3d(1.0, -0.5, 0.3)).normalized();
      const auto guided = ls_cylinder(part.points, near);
      ASSERT_TRUE(guided.has_value()) << guided.error().what;
      expect_equal(*guided, part, 1e-12);
      const auto searched = ls_cylinder(part.points);
      ASSERT_TRUE(searched.has_value()) << searched.error().what;
      expect_equal(*searched, part, 1e-12);
    }
  }
}

TEST(LsCylinder, HoldsFromAMicrometreToAHundredMetresAndFarFromTheOrigin) {
  for (const std::size_t n : {750U, 10000U}) {
    for (const double radius : {1e-3, 1.0, 1e5}) {
      SCOPED_TRACE(testing::Message() << n << " points, radius " << radius);
      const Made part = made(n, radius, 1e-4 * radius, Eigen::Vector3d::Zero(), 3);
      const auto fit = ls_cylinder(part.points, part.axis.direction);
      ASSERT_TRUE(fit.has_value()) << fit.error().what;
      expect_equal(*fit, part, 1e-12);
    }
    const Made far = made(n, 25.0, 2.5e-3, {1e6, -1e6, 1e6}, 4);
    const auto fit = ls_cylinder(far.points);
    ASSERT_TRUE(fit.has_value()) << fit.error().what;
    expect_equal(*fit, far, 1e-12);
  }
}

TEST(LsCylinder, EveryPointTwiceIsTheSameCylinder) {
  Made part = made(900, 25.0, 0.01, {10.0, 20.0, 30.0}, 8);
  const auto once = ls_cylinder(part.points);
  const Points3 copy = part.points;
  part.points.insert(part.points.end(), copy.begin(), copy.end());
  const auto twice = ls_cylinder(part.points);  // long enough to start from a sample
  ASSERT_TRUE(once.has_value() && twice.has_value());
  EXPECT_NEAR(once->radius_mm, twice->radius_mm, 1e-12 * 25.0);
  EXPECT_LT((once->axis.point_mm - twice->axis.point_mm).norm(), 1e-12 * 25.0);
  EXPECT_LT((once->axis.direction - twice->axis.direction).norm(), 1e-12);
  EXPECT_NEAR(once->deviation_mm, twice->deviation_mm, 1e-12 * 25.0);
  EXPECT_NEAR(once->rms_mm, twice->rms_mm, 1e-12 * 25.0);
}

TEST(LsCylinder, IsNotTheOnlyOneThroughTheCornersOfABox) {
  // Two sections of `count` points that deviate by 1 um, `height` apart.
  const auto checked = [](int count, double height) {
    Points3 corners;
    for (int k = 0; k < 2 * count; ++k) {
      const double angle = core::kTwoPi * (k % count) / count;
      const double r = 15.0 + (k % 2 == 0 ? 0.001 : -0.001);
      corners.emplace_back(r * std::cos(angle), r * std::sin(angle), k < count ? 0.0 : height);
    }
    const auto upright = ls_cylinder(corners, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(upright);
    return check_only_cylinder(corners, *upright);
  };
  for (const double height : {21.2, 50.0}) {
    const auto box = checked(4, height);
    ASSERT_FALSE(box);
    EXPECT_EQ(box.error().code, core::Code::kSeveralOptima);
    EXPECT_NE(box.error().what.find("column layer"), std::string::npos);
  }
  EXPECT_TRUE(checked(5, 21.2));
  EXPECT_TRUE(checked(8, 21.2));
}

TEST(LsCylinder, ALargeSetIsRefusedForTheSameReasonsAsASmallOne) {
  const Made part = made(5000, 25.0, 0.01, {10.0, 20.0, 30.0}, 9);
  for (const std::size_t row : {0U, 2777U, 4999U}) {
    Points3 bad = part.points;
    bad[row].y() = std::numeric_limits<double>::quiet_NaN();
    const auto refused = ls_cylinder(bad, part.axis.direction);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, core::Code::kNotFinite);
    EXPECT_THAT(refused.error().what, testing::HasSubstr(std::to_string(row)));
  }
  Points3 line, plane, four;
  for (int i = 0; i < 3000; ++i) {
    line.emplace_back(1.0 * i, 2.0 * i, 3.0 * i);
    plane.emplace_back(25.0 * std::cos(i), 25.0 * std::sin(i), 3.0);
    four.push_back(part.points[static_cast<std::size_t>(i % 4)]);
  }
  EXPECT_EQ(ls_cylinder(line).error().code, core::Code::kCollinear);
  EXPECT_EQ(ls_cylinder(plane).error().code, core::Code::kRank);
  EXPECT_EQ(ls_cylinder(four).error().code, core::Code::kTooFewPoints);
}

TEST(LsCylinder, FewOddPointsAmongManyAreNotMissed) {
  // A sample would see one circle only: the few points that fix the tilt must still count.
  core::KeyedNoise noise(5, {2});
  Made part;
  for (int i = 0; i < 40000; ++i) {
    const double theta = core::kTwoPi * noise.uniform();
    const double z = i % 8000 == 17 ? 40.0 + 0.001 * i : 0.0;
    const double r = 25.0 + 1e-3 * noise.normal();
    part.points.emplace_back(r * std::cos(theta), r * std::sin(theta), z);
  }
  part.axis = {{0.0, 0.0, 20.0}, Eigen::Vector3d::UnitZ()};
  const auto fit = ls_cylinder(part.points, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(fit.has_value()) << fit.error().what;
  expect_equal(*fit, part, 1e-11);  // five points hold the tilt: a worse condition
}

}  // namespace
}  // namespace rondure::fit
