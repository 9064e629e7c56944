#include "fit/least_squares/probe_tip.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;

TEST(ProbeTip, ReproducesTheWorkedExampleOfTheReferenceSphere) {
  const Points3 tips = {{100, 50, 44.4994},
                        {114.4988, 50, 30},
                        {100, 64.4991, 30},
                        {85.5003, 50, 30},
                        {100, 35.5015, 30},
                        {107.2497, 57.2497, 40.252624},
                        {92.75045, 57.24955, 40.252412},
                        {92.7506, 42.7506, 40.2522},
                        {107.24955, 42.75045, 40.252412}};
  const auto tip = qualify_tip(tips, 12.5006);
  ASSERT_TRUE(tip.has_value());
  EXPECT_NEAR((tip->sphere_center_mm - Eigen::Vector3d(99.999800, 50.000300, 30.000219)).norm(),
              0.0, 1e-6);
  EXPECT_NEAR(tip->radius_mm + 12.5006, 14.499006960, 0.6e-9);
  EXPECT_NEAR(tip->radius_mm, 1.998407, 0.5e-6);
  EXPECT_NEAR(tip->form_mm * 1e3, 0.805, 0.5e-3);
  // sigma_rho / sigma_point = 0.493, with sigma_point from the residuals of m - 4 = 5 freedoms.
  double squares = 0.0;
  for (const auto& p : tips)
    squares += std::pow((p - tip->sphere_center_mm).norm() - 14.499006960, 2);
  EXPECT_NEAR(tip->radius_sigma_mm / std::sqrt(squares / 5.0), 0.493, 0.5e-3);
}

TEST(ProbeTip, StatesTheScatterOfItsRadius) {
  const double sigma = 1e-3;
  double sum = 0.0;
  double stated = 0.0;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    core::KeyedNoise noise(static_cast<std::uint64_t>(run), {7});
    Points3 tips;
    for (int k = 0; k < 13; ++k) {
      const double z = 1.0 - k / 13.0;
      const double a = 2.4 * k;
      const Eigen::Vector3d n(std::sqrt(1 - z * z) * std::cos(a),
                              std::sqrt(1 - z * z) * std::sin(a), z);
      tips.emplace_back(Eigen::Vector3d(400, -300, 50) + (14.5 + sigma * noise.normal()) * n);
    }
    const auto tip = qualify_tip(tips, 12.5);
    ASSERT_TRUE(tip.has_value());
    sum += std::pow(tip->radius_mm - 2.0, 2);
    stated += std::pow(tip->radius_sigma_mm, 2);
  }
  EXPECT_NEAR(stated / sum, 1.0, 0.1);
}

TEST(ProbeTip, RefusesTouchesOnOneCircleAndTooFew) {
  Points3 ring;
  for (int k = 0; k < 8; ++k)
    ring.emplace_back(14.5 * std::cos(0.7 * k), 14.5 * std::sin(0.7 * k), 30.0);
  EXPECT_EQ(qualify_tip(ring, 12.5).error().code, core::Code::kRank);
  EXPECT_EQ(qualify_tip(Points3{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}, 0.5).error().code,
            core::Code::kTooFewPoints);
}

}  // namespace
}  // namespace rondure::fit
