#include "fit/least_squares/circle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;

double squares(const Points2& points, const Eigen::Vector2d& center, double radius) {
  double sum = 0.0;
  for (const auto& p : points) sum += std::pow((p - center).norm() - radius, 2);
  return sum;
}

TEST(LsCircle, HasNoNeighbourWithLessSquares) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {1});
    Points2 points;
    const double arc = (seed % 2 == 0 ? 60.0 : 360.0) * core::kDegree;
    for (int k = 0; k < 20; ++k) {
      const double theta = arc * noise.uniform();
      const double r = 30.0 + 0.01 * noise.normal();
      points.emplace_back(100.0 + r * std::cos(theta), -50.0 + r * std::sin(theta));
    }
    const auto circle = ls_circle(points);
    ASSERT_TRUE(circle.has_value());
    const double least = squares(points, circle->center_mm, circle->radius_mm);
    for (const double h : {1e-3, 1e-5}) {
      for (int k = 0; k < 24; ++k) {
        const double a = core::kTwoPi * k / 24.0;
        EXPECT_GE(squares(points, circle->center_mm + h * Eigen::Vector2d(std::cos(a), std::sin(a)),
                          circle->radius_mm + h * std::sin(3.0 * a)),
                  least * (1.0 - 1e-12));
      }
    }
  }
}

/// Newton on the two equations of the centre in 80-bit numbers, the radius being the mean distance.
LsCircle converged(const Points2& points, const Eigen::Vector2d& start) {
  using Wide2 = Eigen::Matrix<long double, 2, 1>;
  Wide2 center = start.cast<long double>();
  const auto n = static_cast<long double>(points.size());
  long double radius = 0.0L;
  long double sum = 0.0L;
  for (int i = 0; i < 200; ++i) {
    Wide2 pull = Wide2::Zero();
    Wide2 unit = Wide2::Zero();
    radius = 0.0L;
    for (const auto& p : points) radius += (p.cast<long double>() - center).norm() / n;
    sum = 0.0L;
    for (const auto& p : points) {
      const Wide2 v = p.cast<long double>() - center;
      pull += v / n;
      unit += v.normalized() / n;
      sum += (v.norm() - radius) * (v.norm() - radius);
    }
    const Wide2 move = pull - radius * unit;  // fixed point of the stationarity equations
    center += move;
    if (move.norm() < 1e-19L * radius) break;
  }
  return {center.cast<double>(), static_cast<double>(radius), 0.0,
          static_cast<double>(std::sqrt(sum / n))};
}

TEST(LsCircle, IsTheFullyConvergedMinimumForSmallAndLargeSets) {
  for (const std::size_t n : {36U, 1000U, 1001U, 30000U}) {
    for (const double radius : {1e-3, 25.0, 1e5}) {
      for (const double place : {0.0, 4.0}) {
        SCOPED_TRACE(testing::Message() << n << " points, radius " << radius << ", at " << place);
        core::KeyedNoise noise(n, {5});
        const Eigen::Vector2d center(place * radius, -place * radius);
        Points2 points;
        for (std::size_t k = 0; k < n; ++k) {
          const double theta = core::kTwoPi * noise.uniform();
          const double r = radius * (1.0 + 1e-4 * std::cos(2.0 * theta) + 1e-5 * noise.normal());
          points.emplace_back(center + r * Eigen::Vector2d(std::cos(theta), std::sin(theta)));
        }
        const auto circle = ls_circle(points);
        ASSERT_TRUE(circle.has_value());
        const LsCircle want = converged(points, center);
        EXPECT_NEAR(circle->radius_mm, want.radius_mm, 1e-12 * radius);
        EXPECT_LT((circle->center_mm - want.center_mm).norm(), 1e-12 * radius * (1.0 + place));
        EXPECT_NEAR(circle->rms_mm, want.rms_mm, 1e-12 * radius);
        double low = std::numeric_limits<double>::infinity();
        double high = 0.0;
        for (const auto& p : points) {
          low = std::min(low, (p - want.center_mm).norm());
          high = std::max(high, (p - want.center_mm).norm());
        }
        EXPECT_NEAR(circle->deviation_mm, high - low, 4e-12 * radius * (1.0 + place));
      }
    }
  }
}

/// Squares about the best centre at a distance below the points, the radius being the mean
/// distance: what a flat arc that is its own mirror image leaves to search. 80-bit numbers.
long double squares_at_depth(const Points2& points, long double depth) {
  long double mean = 0.0L;
  long double sum = 0.0L;
  const auto n = static_cast<long double>(points.size());
  for (const auto& p : points)
    mean += std::hypot(static_cast<long double>(p.x()), p.y() + depth) / n;
  for (const auto& p : points) {
    const long double d = std::hypot(static_cast<long double>(p.x()), p.y() + depth) - mean;
    sum += d * d;
  }
  return sum;
}

TEST(LsCircle, SettlesOnFlatArcs) {
  const Points2 flat = {{0, 2}, {1, -1.001}, {-1, -1.001}, {10, 0.001}, {-10, 0.001}};
  const auto circle = ls_circle(flat);
  ASSERT_TRUE(circle.has_value()) << circle.error().what;
  EXPECT_NEAR(circle->center_mm.x(), 0.0, 1e-6);
  EXPECT_NEAR(circle->center_mm.y(), -3283.290161859, 1e-6);
  EXPECT_NEAR(circle->radius_mm, 3283.296314227, 1e-6);
  for (const double height : {0.3, 0.03, 0.003}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(testing::Message() << "height " << height << " mm, seed " << seed);
      core::KeyedNoise noise(seed, {6});
      Points2 points;
      for (int k = 0; k <= 10; ++k) {
        const double x = k - 0.4 * noise.uniform();
        const double y = -height * x * x / 100.0 + 0.2 * height * noise.normal();
        points.emplace_back(x, y);
        points.emplace_back(-x, y);
      }
      const auto arc = ls_circle(points);
      ASSERT_TRUE(arc.has_value()) << arc.error().what;
      const auto depth = static_cast<long double>(-arc->center_mm.y());
      const long double least = squares_at_depth(points, depth);
      for (const long double factor : {0.9L, 0.999L, 1.001L, 1.1L})
        EXPECT_LE(least, squares_at_depth(points, factor * depth));
    }
  }
}

TEST(LsCircle, NamesTheBadRowOfALargeSet) {
  Points2 points;
  for (int k = 0; k < 4000; ++k) points.emplace_back(25.0 * std::cos(k), 25.0 * std::sin(k));
  points[3456].x() = std::numeric_limits<double>::infinity();
  const auto refused = ls_circle(points);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, core::Code::kNotFinite);
  EXPECT_NE(refused.error().what.find("3456"), std::string::npos);
}

TEST(AlgebraicCircle, IsExactForThreePoints) {
  const auto circle = algebraic_circle(Points2{{1001.0, 0.0}, {1000.0, 1.0}, {999.0, 0.0}});
  ASSERT_TRUE(circle.has_value());
  EXPECT_NEAR((circle->center_mm - Eigen::Vector2d(1000.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(circle->radius_mm, 1.0, 1e-12);
}

TEST(AlgebraicCircle, RefusesPointsOnALine) {
  EXPECT_EQ(algebraic_circle(Points2{{0, 0}, {1, 2}, {2, 4}, {5, 10}}).error().code,
            core::Code::kCollinear);
  EXPECT_EQ(algebraic_circle(Points2{{3, 3}, {3, 3}, {3, 3}}).error().code,
            core::Code::kTooFewPoints);
}

}  // namespace
}  // namespace rondure::fit
