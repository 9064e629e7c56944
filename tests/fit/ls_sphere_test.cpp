#include "fit/least_squares/sphere.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;
using Wide3 = Eigen::Matrix<long double, 3, 1>;

/// Points of a sphere, of its cap above `lowest` (-1: all of it).
Points3 sphere_points(std::size_t n, const Eigen::Vector3d& center, double radius, double form,
                      double lowest, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {31});
  Points3 out;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = lowest + (1.0 - lowest) * noise.uniform();
    const double a = 6.283185307179586 * noise.uniform();
    const double across = std::sqrt(1.0 - z * z);
    out.push_back(center + (radius + form * noise.normal()) *
                               Eigen::Vector3d(across * std::cos(a), across * std::sin(a), z));
  }
  return out;
}

/// Pull of the residuals on the centre and the radius, in 80-bit numbers: 0 at the minimum.
double largest_pull(const Points3& points, const LsSphere& sphere) {
  Wide3 pull = Wide3::Zero();
  long double swell = 0.0L;
  for (const auto& p : points) {
    const Wide3 v = p.cast<long double>() - sphere.center_mm.cast<long double>();
    const long double residual = v.norm() - sphere.radius_mm;
    pull += residual * v / v.norm();
    swell += residual;
  }
  const auto n = static_cast<long double>(points.size());
  return static_cast<double>(std::max(pull.norm(), std::abs(swell)) / n);
}

TEST(LsSphere, ResidualsPullNeitherOnTheCentreNorOnTheRadius) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const double radius = std::pow(10.0, static_cast<double>(seed % 7) - 2.0);
    const double lowest = seed % 2 == 0 ? -1.0 : 0.7;
    const Points3 points =
        sphere_points(5 + 10 * (seed % 6), 3.0 * radius * Eigen::Vector3d(1, -2, 1), radius,
                      1e-4 * radius, lowest, seed);
    const auto sphere = ls_sphere(points);
    ASSERT_TRUE(sphere.has_value()) << sphere.error().what;
    EXPECT_LT(largest_pull(points, *sphere), 4e-15 * radius);
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    double squares = 0.0;
    for (const auto& p : points) {
      const double r = (p - sphere->center_mm).norm();
      low = std::min(low, r);
      high = std::max(high, r);
      squares += (r - sphere->radius_mm) * (r - sphere->radius_mm);
    }
    EXPECT_NEAR(sphere->deviation_mm, high - low, 1e-14 * radius);
    EXPECT_NEAR(sphere->rms_mm, std::sqrt(squares / static_cast<double>(points.size())),
                1e-14 * radius);
  }
}

TEST(LsSphere, IsExactForFourPointsAndKeepsItsDigitsFarAway) {
  const auto four = ls_sphere(Points3{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {-3, 0, 0}});
  ASSERT_TRUE(four.has_value());
  EXPECT_LT(four->center_mm.norm(), 1e-14);
  EXPECT_NEAR(four->radius_mm, 3.0, 1e-14);
  EXPECT_NEAR(four->rms_mm, 0.0, 1e-14);
  const Eigen::Vector3d place(1e6, -1e6, 1e6);
  const auto far = ls_sphere(sphere_points(200, place, 12.5, 0.0, -1.0, 3));
  ASSERT_TRUE(far.has_value());
  EXPECT_LT((far->center_mm - place).norm(), 1e-9);  // points are stored to 1e-10
  EXPECT_NEAR(far->radius_mm, 12.5, 1e-10);
}

TEST(LsSphere, RefusesWhatFixesNoSphere) {
  EXPECT_EQ(ls_sphere({}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(ls_sphere(Points3{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}).error().code,
            core::Code::kTooFewPoints);
  EXPECT_EQ(ls_sphere(Points3{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}).error().code,
            core::Code::kRank);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ls_sphere(Points3{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {nan, 0, 0}}).error().code,
            core::Code::kNotFinite);
}

}  // namespace
}  // namespace rondure::fit
