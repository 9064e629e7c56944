#include "fit/least_squares/probe_tip.h"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "fit/least_squares/circle.h"

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

/// Tip centres of touches, each horizontal and through the axis of a leaning column.
Points3 column_tips(const Eigen::Vector3d& through, const Eigen::Vector3d& slope, double radius) {
  const Eigen::Vector3d axis = slope.normalized();
  Points3 out;
  for (const double z : {-10.0, 0.0, 10.0}) {
    for (int i = 0; i < 8; ++i) {
      const double angle = i * M_PI / 4.0;
      const Eigen::Vector3d u(std::cos(angle), std::sin(angle), 0.0);
      out.emplace_back(through + z * slope + radius / u.cross(axis).norm() * u);
    }
  }
  return out;
}

TEST(ProbeTip, ReproducesTheWorkedExampleOfTheColumnWhateverItsLean) {
  const double degree = M_PI / 180.0;
  const Points3 tips =
      column_tips({300.2, -0.35, 100.0}, {std::tan(0.7 * degree), std::tan(-0.3 * degree), 1.0},
                  12.5004 + 1.9985);
  const std::pair<std::size_t, Eigen::Vector3d> printed[] = {{1, {314.577803, -0.297640, 90.0}},
                                                             {4, {289.824770, 9.955412, 90.0}},
                                                             {11, {300.2, 14.149099, 100.0}},
                                                             {24, {310.575230, -10.655412, 110.0}}};
  for (const auto& [number, at] : printed) {
    EXPECT_LT((tips[number - 1] - at).cwiseAbs().maxCoeff(), 0.6e-6) << number;
  }
  const auto tip = qualify_tip_on_column(tips, 12.5004);
  ASSERT_TRUE(tip) << tip.error().what;
  EXPECT_NEAR(tip->radius_mm, 1.9985, 1e-9);
  EXPECT_NEAR(std::atan2(tip->column_axis.x(), tip->column_axis.z()) / degree, 0.7, 1e-7);
  EXPECT_NEAR(std::atan2(tip->column_axis.y(), tip->column_axis.z()) / degree, -0.3, 1e-7);
  EXPECT_NEAR(tip->radius_per_touch, 0.2042, 1e-4);
  // One height as a circle is 0.640 um too large, and refused.
  std::vector<Eigen::Vector2d> middle;
  for (std::size_t i = 8; i < 16; ++i) middle.emplace_back(tips[i].head<2>());
  EXPECT_NEAR(1e3 * (ls_circle(middle)->radius_mm - 12.5004 - 1.9985), 0.640, 1e-3);
  const auto alone = qualify_tip_on_column(std::span(tips).subspan(8, 8), 12.5004);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, core::Code::kRank);
  EXPECT_EQ(qualify_tip_on_column(std::span(tips).first(5), 12.5).error().code,
            core::Code::kTooFewPoints);
}

// The circle of one height is too large by R eps^2 / 4, two heights know the lean.
TEST(ProbeTip, OfOneHeightOfALeaningColumnWouldBeTooLarge) {
  for (const auto& [lean_deg, printed_um] :
       std::vector<std::pair<double, double>>{{0.5, 0.28}, {1.0, 1.10}, {2.0, 4.42}}) {
    SCOPED_TRACE(lean_deg);
    const Points3 tips =
        column_tips({0.0, 0.0, 50.0}, {std::tan(lean_deg * M_PI / 180.0), 0.0, 1.0}, 14.5);
    std::vector<Eigen::Vector2d> one_height;
    for (std::size_t i = 0; i < 8; ++i) one_height.emplace_back(tips[i].head<2>());
    EXPECT_NEAR(1e3 * (ls_circle(one_height)->radius_mm - 14.5), printed_um, 0.0051);
    EXPECT_NEAR(qualify_tip_on_column(tips, 12.5)->radius_mm, 2.0, 1e-9);
  }
}

TEST(ProbeTip, StatesTheScatterOfItsRadiusOnAColumn) {
  const Points3 exact = column_tips({0.0, 0.0, 50.0}, {0.02, 0.01, 1.0}, 14.5);
  const auto of_exact = qualify_tip_on_column(exact, 12.5);
  ASSERT_TRUE(of_exact);
  const Eigen::VectorXd weights = radius_weights(exact, *of_exact);
  const double sigma = 1e-3;
  double sum = 0.0;
  double stated = 0.0;
  for (int run = 0; run < 1000; ++run) {
    core::KeyedNoise noise(static_cast<std::uint64_t>(run), {8});
    Points3 tips = exact;
    double foretold = 0.0;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      const Eigen::Vector3d away = tips[i] - of_exact->sphere_center_mm;
      const Eigen::Vector3d n =
          (away - of_exact->column_axis.dot(away) * of_exact->column_axis).normalized();
      const double error = sigma * noise.normal();
      tips[i] += error * n;
      foretold += weights[static_cast<Eigen::Index>(i)] * error;
    }
    const auto tip = qualify_tip_on_column(tips, 12.5);
    ASSERT_TRUE(tip);
    EXPECT_NEAR(tip->radius_mm - 2.0, foretold, 1e-6);
    sum += std::pow(tip->radius_mm - 2.0, 2);
    stated += std::pow(tip->radius_sigma_mm, 2);
  }
  EXPECT_NEAR(stated / sum, 1.0, 0.12);
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
