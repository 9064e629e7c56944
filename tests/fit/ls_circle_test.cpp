#include "fit/ls_circle.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double squares(const Points& points, const Eigen::Vector2d& center, double radius) {
  double sum = 0.0;
  for (const auto& p : points) sum += std::pow((p - center).norm() - radius, 2);
  return sum;
}

TEST(LsCircle, HasNoNeighbourWithLessSquares) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {1});
    Points points;
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

TEST(AlgebraicCircle, IsExactForThreePoints) {
  const auto circle = algebraic_circle(Points{{1001.0, 0.0}, {1000.0, 1.0}, {999.0, 0.0}});
  ASSERT_TRUE(circle.has_value());
  EXPECT_NEAR((circle->center_mm - Eigen::Vector2d(1000.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(circle->radius_mm, 1.0, 1e-12);
}

TEST(AlgebraicCircle, RefusesPointsOnALine) {
  EXPECT_EQ(algebraic_circle(Points{{0, 0}, {1, 2}, {2, 4}, {5, 10}}).error().code,
            core::Code::kCollinear);
  EXPECT_EQ(algebraic_circle(Points{{3, 3}, {3, 3}, {3, 3}}).error().code,
            core::Code::kTooFewPoints);
}

}  // namespace
}  // namespace rondure::fit
