#include "fit/geometry/enclosing_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "fit/zone/descent.h"

namespace rondure::fit {
namespace {

template <int D>
using PointsOf = std::vector<Eigen::Matrix<double, D, 1>>;

template <int D>
WorkingPoints<D> working(const PointsOf<D>& points) {
  WorkingPoints<D> out;
  out.assign(points, Eigen::Matrix<double, D, 1>::Zero());
  return out;
}

/// A ball that holds all points, and whose centre is a mean of points on it, is the smallest.
template <int D>
void expect_smallest(const PointsOf<D>& points, const Ball<D>& ball) {
  ASSERT_TRUE(ball.solved);
  double size = 0.0;
  double high = 0.0;
  double low = std::numeric_limits<double>::infinity();
  for (const auto& p : points) {
    size = std::max(size, p.cwiseAbs().maxCoeff());
    high = std::max(high, (p - ball.center_mm).norm());
    low = std::min(low, (p - ball.center_mm).norm());
  }
  const double slack = 1e-13 * std::max(size, 1.0);
  EXPECT_NEAR(ball.zone.high, high, slack);
  EXPECT_NEAR(ball.zone.low, low, slack);
  Eigen::Matrix<double, D, 1> mean = Eigen::Matrix<double, D, 1>::Zero();
  double sum = 0.0;
  for (const Contact& c : ball.outer) {
    EXPECT_GT(c.multiplier, 0.0);
    EXPECT_NEAR((points[c.index] - ball.center_mm).norm(), high, 10.0 * slack);
    mean += c.multiplier * points[c.index];
    sum += c.multiplier;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_LE((mean - ball.center_mm).norm(), 10.0 * slack);
}

/// Sets that are hard in one way each.
template <int D>
PointsOf<D> hard_set(std::uint64_t seed) {
  core::KeyedNoise noise(seed, {61, D});
  PointsOf<D> out;
  const int count = 1 + static_cast<int>(seed % 60);
  for (int i = 0; i < count; ++i) {
    Eigen::Matrix<double, D, 1> p;
    for (int k = 0; k < D; ++k) p(k) = noise.normal();
    switch (seed % 5) {
      case 0:  // on one ball to round-off
        p.normalize();
        break;
      case 1:  // a lattice: ties and duplicates
        p = p.array().round().matrix();
        break;
      case 2:  // a line
        p = p(0) * Eigen::Matrix<double, D, 1>::Ones();
        break;
      case 3:  // nearly round
        p = p.normalized() * (25.0 + 0.001 * noise.normal());
        break;
      default:
        break;
    }
    out.push_back(p);
  }
  return out;
}

template <int D>
void solve_hard_sets() {
  EnclosingBall<D> ball;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    const auto points = hard_set<D>(seed);
    expect_smallest<D>(points, ball.enclose(working<D>(points), false, distance_round_off(25.0)));
  }
}

TEST(EnclosingBall, HoldsAllPointsOfAPlaneAndRestsOnItsContacts) { solve_hard_sets<2>(); }
TEST(EnclosingBall, HoldsAllPointsOfSpaceAndRestsOnItsContacts) { solve_hard_sets<3>(); }

TEST(EnclosingBall, GrowsWithPointsThatAreAddedToThoseItHolds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    auto points = hard_set<2>(seed);
    auto work = working<2>(points);
    EnclosingBall<2> ball;
    const double first = ball.enclose(work, false, distance_round_off(25.0)).zone.high;
    for (const auto& p : hard_set<2>(seed + 1000)) {
      work.add(points.size(), p);
      points.push_back(p);
    }
    const auto grown = ball.enclose(work, true, distance_round_off(25.0));
    expect_smallest<2>(points, grown);
    EXPECT_GE(grown.zone.high, first - 1e-13 * 25.0);
  }
}

}  // namespace
}  // namespace rondure::fit
