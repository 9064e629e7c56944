// Wheel centre and radius: worked examples, scatter, properties, bad input.

#include "fit/wheel/wheel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "fit/wheel/loss.h"
#include "tests/core/full.h"
#include "tests/fit/wheel_cases.h"

namespace rondure::fit {
namespace {

using test::arc_points;
using test::example_1;
using test::example_2;
using test::Points2;
using ::testing::HasSubstr;

// Points are printed to 1e-6 mm: half a digit of each reaches a centre kappa times.
constexpr double kDigit = 1.01e-6;

bool warned(const WheelMeasurement& m, core::Code code) {
  return std::any_of(m.warnings.begin(), m.warnings.end(),
                     [&](const core::Error& w) { return w.code == code; });
}

WheelOptions plain(WheelMean mean = WheelMean::kAsPublished) {
  WheelOptions out;
  out.mean = mean;
  return out;
}

TEST(FourPointCenter, GivesEveryRowOfWorkedExample1) {
  struct Row {
    std::array<std::size_t, 4> points;
    double x, z, psi_deg, ab, cd, kappa;
  };
  const std::array<Row, 6> rows = {{
      {{1, 5, 3, 7}, 12.001448, -6.996698, 90.0000, 100.000000, 100.000000, 1.0000},
      {{2, 6, 4, 8}, 11.999427, -7.000819, 90.0000, 99.999999, 100.000000, 1.0000},
      {{1, 4, 5, 7}, 12.002022, -6.995879, 22.4999, 92.389801, 70.707142, 3.2908},
      {{2, 5, 6, 8}, 11.998762, -6.997050, 22.4997, 92.385182, 70.711385, 3.2907},
      {{1, 6, 3, 7}, 11.998832, -6.997160, 67.5002, 92.390724, 100.000000, 1.1278},
      {{3, 6, 8, 2}, 12.004590, -6.999909, 22.5001, 92.391648, 70.709971, 3.2906},
  }};
  const Points2 points = example_1();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Row& row : rows) {
    SCOPED_TRACE(row.x);
    auto places = row.points;
    for (auto& p : places) --p;
    const auto c = four_point_center(points, places, 50.0);
    EXPECT_NEAR(c.center_mm.x(), row.x, kDigit * row.kappa);
    EXPECT_NEAR(c.center_mm.y(), row.z, kDigit * row.kappa);
    EXPECT_NEAR(c.psi_rad / core::kDegree, row.psi_deg, 5.1e-5);
    EXPECT_NEAR(c.first_chord_mm, row.ab, kDigit);
    EXPECT_NEAR(c.second_chord_mm, row.cd, kDigit);
    EXPECT_NEAR(c.kappa, row.kappa, 5.1e-5);
    sum += c.center_mm / 6.0;
  }
  EXPECT_NEAR(sum.x(), 12.000847, kDigit);
  EXPECT_NEAR(sum.y(), -6.997919, kDigit);
  const auto parallel = four_point_center(points, {0, 3, 5, 6}, 50.0);
  EXPECT_NEAR(parallel.psi_rad / core::kDegree, 0.0051, 5.1e-5);
  // Their bisectors are nearly one line: a rounding of 1e-6 mm moves the crossing by millimetres.
  EXPECT_NEAR(parallel.kappa, 22654.0, 22654.0 * 1e-3);
  EXPECT_NEAR(parallel.center_mm.x(), -3.463192, 0.03);
  EXPECT_NEAR(parallel.center_mm.y(), -76.757686, 0.1);
}

TEST(FourPointCenter, AmplifiesNoiseByKappa) {
  // Two diameters at 90 deg, and at 15 deg: kappa 1.000 and 3.864.
  for (const double angle : {90.0, 15.0}) {
    SCOPED_TRACE(angle);
    core::KeyedNoise noise(3, {static_cast<std::uint64_t>(angle)});
    constexpr double kSigma = 1e-3;
    const int draws = 20000;
    double squares = 0.0;
    double kappa = 0.0;
    for (int i = 0; i < draws; ++i) {
      Points2 points;
      for (const double deg : {0.0, 180.0, angle, angle + 180.0}) {
        const double r = 50.0 + kSigma * noise.normal();
        points.emplace_back(r * std::cos(deg * core::kDegree), r * std::sin(deg * core::kDegree));
      }
      const auto c = four_point_center(points, {0, 1, 2, 3}, 50.0);
      squares += c.center_mm.squaredNorm();
      kappa = c.kappa;
    }
    EXPECT_NEAR(kappa, angle > 45.0 ? 1.0 : 3.864, 1e-3);
    EXPECT_NEAR(std::sqrt(squares / draws) / kSigma, kappa, 0.02 * kappa);
  }
}

TEST(Wheel, RunOutOfAPartialArcIsABound) {
  // Eccentricity 5.85 um: run-out 11.7 um; an arc of 60 deg sees a part of it.
  const Eigen::Vector2d axis(12.0, -7.0);
  WheelOptions options;
  options.axis_mm = axis;
  for (const double arc_deg : {60.0, 200.0, 269.0, 271.0, 360.0}) {
    SCOPED_TRACE(arc_deg);
    const auto points =
        test::arc_points(24, arc_deg, 50.0, 0.0, 1, axis + Eigen::Vector2d(0, 5.85e-3));
    const auto m = measure_wheel(points, options);
    ASSERT_TRUE(m) << m.error().what;
    ASSERT_TRUE(m->runout);
    EXPECT_LE(m->runout->fim_mm, 11.7e-3 + 1e-9);
    const bool whole = arc_deg > 270.0;
    EXPECT_EQ(m->sees_whole_turn(), whole);
    EXPECT_EQ(m->runout->bound_because.empty(), whole) << m->runout->bound_because;
    EXPECT_EQ(m->effective_radius_mm().has_value(), whole);
    if (!whole) continue;
    // What the gap of 89 deg can hide of the eccentricity, and no more.
    const double loss = loss_in_gap_mm(m->order.largest_gap_rad, std::array{5.85e-3});
    EXPECT_GT(m->runout->fim_mm, 11.7e-3 - loss - 1e-6);
  }
}

TEST(Wheel, APointThatWasDroppedIsRunOutAndFormAllTheSame) {
  const Eigen::Vector2d axis(12.0, -7.0);
  for (const double proud_um : {46.0, -46.0}) {
    SCOPED_TRACE(proud_um);
    auto points = test::arc_points(16, 360.0, 50.0, 2e-4, 3, axis);
    points[5] += proud_um * core::kMicrometre * (points[5] - axis).normalized();
    WheelOptions options;
    options.axis_mm = axis;
    options.robust = true;
    const auto m = measure_wheel(points, options);
    ASSERT_TRUE(m) << m.error().what;
    ASSERT_EQ(m->dropped.size(), 1U);
    EXPECT_NEAR(m->runout->fim_mm, 46e-3, 1e-3);
    EXPECT_NEAR(m->runout->effective_radius_mm, proud_um > 0.0 ? 50.046 : 50.0, 1e-3);
    EXPECT_NEAR(m->radius_mm, 50.0, 1e-3);
    ASSERT_TRUE(m->zone);
    options.robust = false;
    const auto plain = measure_wheel(points, options);
    ASSERT_TRUE(plain) << plain.error().what;
    EXPECT_EQ(m->zone->width_mm(), plain->zone->width_mm());
    EXPECT_EQ(m->runout->fim_mm, plain->runout->fim_mm);
  }
}

// W-1 and W-2 of the specification: the bound of what lies between the points.
TEST(Wheel, BoundsTheLossBetweenPointsAsSpecified) {
  const std::array amplitudes_mm = {5.0e-3, 1.2e-3, 0.8e-3};
  EXPECT_NEAR(loss_in_gap_mm(22.5 * core::kDegree, amplitudes_mm), 0.644485e-3,
              5e-9);  // printed as 0.645
  EXPECT_NEAR(loss_in_gap_mm(300.0 * core::kDegree, amplitudes_mm), 26.66e-3, 5e-6);
  // Roundness has no eccentricity in it.
  EXPECT_NEAR(loss_in_gap_mm(22.5 * core::kDegree, amplitudes_mm, 2), 0.452e-3, 1e-6);
}

TEST(Wheel, FindsAmplitudesOnlyWhereThePlacesHoldThem) {
  const auto points = [](int n, double arc_deg) {
    test::Points2 out;
    for (int i = 0; i < n; ++i) {
      const double a = arc_deg * core::kDegree * i / n;
      const double r = 50.0 + 1.2e-3 * std::cos(2.0 * a - 0.7) + 0.8e-3 * std::cos(3.0 * a);
      out.emplace_back(r * std::cos(a), r * std::sin(a));
    }
    return out;
  };
  const auto all_round = found_amplitudes(points(16, 360.0), {0.0, 0.0});
  ASSERT_EQ(all_round.size(), 7U);
  EXPECT_NEAR(all_round[0], 0.0, 1e-9);
  EXPECT_NEAR(all_round[1], 1.2e-3, 1e-9);
  EXPECT_NEAR(all_round[2], 0.8e-3, 1e-9);
  EXPECT_TRUE(found_amplitudes(points(8, 60.0), {0.0, 0.0}).empty());
  // Without noise in the points a declared one takes nothing off.
  const auto declared = found_amplitudes(points(16, 360.0), {0.0, 0.0}, 5e-3);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(declared[k], all_round[k], 1e-12);
}

// Of noise alone an order of n even points reads sigma sqrt(4 / n) in the root of its mean square.
TEST(Wheel, TakesTheNoiseOffTheAmplitudesItFinds) {
  double raw = 0.0;
  double less = 0.0;
  constexpr int kRuns = 100;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto points = arc_points(24, 360.0, 50.0, 1e-3, seed);
    for (const double a : found_amplitudes(points, {0.0, 0.0})) raw += a * a / (11 * kRuns);
    for (const double a : found_amplitudes(points, {0.0, 0.0}, 1e-3)) less += a / (11 * kRuns);
  }
  EXPECT_NEAR(std::sqrt(raw), 1e-3 * std::sqrt(4.0 / 24.0), 0.02e-3);
  EXPECT_LT(less, 0.5 * std::sqrt(raw));
}

TEST(Wheel, WarnsOfAnAxisThatIsItsOwnCentre) {
  const auto points = arc_points(24, 360.0, 50.0, 1e-3, 7, {12.0, -7.0});
  WheelOptions options;
  options.axis_mm = ls_circle(points)->center_mm;
  const auto own = measure_wheel(points, options);
  ASSERT_TRUE(own) << own.error().what;
  EXPECT_TRUE(warned(*own, core::Code::kNoAxis));
  options.axis_mm->x() += 2e-3;
  EXPECT_FALSE(warned(*measure_wheel(points, options), core::Code::kNoAxis));
}

// The spread of a lobed wheel is its form; the declared error of a point is not.
TEST(Wheel, ADeclaredErrorOfThePointsReplacesTheSpread) {
  const auto points = test::arc_points(16, 360.0, 50.0, 1.2e-3, 2);
  WheelOptions options;
  options.errors = WheelPointErrors{.point_mm = 0.4e-3};
  const auto m = measure_wheel(points, options);
  ASSERT_TRUE(m) << m.error().what;
  EXPECT_NEAR(m->radius_uncertainty_mm, 0.1e-3, 1e-8);
  options.errors = WheelPointErrors{.point_mm = 0.4e-3, .scale_1 = 20e-6, .threshold_mm = 0.5e-3};
  const auto more = measure_wheel(points, options);
  ASSERT_TRUE(more) << more.error().what;
  EXPECT_NEAR(more->radius_uncertainty_mm, std::sqrt(0.1 * 0.1 + 1.0 + 0.5 * 0.5) * 1e-3, 1e-6);
  options.errors->point_mm = -1.0;
  EXPECT_FALSE(measure_wheel(points, options));
}

TEST(Wheel, GivesTheCenterRadiusAndRoundnessOfWorkedExample1) {
  const auto mean = measure_wheel(example_1(), plain());
  ASSERT_TRUE(mean) << mean.error().what;
  EXPECT_EQ(mean->centers.accepted.size(), 70U);
  EXPECT_NEAR(mean->center_mm.x(), 12.000438, kDigit);
  EXPECT_NEAR(mean->center_mm.y(), -6.998759, kDigit);
  EXPECT_NEAR(mean->radius_mm, 50.0, kDigit);
  EXPECT_NEAR(mean->deviation_mm / core::kMicrometre, 4.535, 1.6e-3);
  EXPECT_NEAR(mean->check.center_mm.x(), 12.000438, kDigit);
  EXPECT_NEAR(mean->check.center_mm.y(), -6.998759, kDigit);
  const std::array r = {50.001353, 49.997732, 50.001853, 49.999646,
                        49.998646, 50.002267, 49.998146, 50.000354};
  for (std::size_t i = 0; i < r.size(); ++i) {
    EXPECT_NEAR(mean->radius_mm + mean->deviations_mm[i], r[i], 2.0 * kDigit) << i;
  }
  ASSERT_TRUE(mean->zone);
  EXPECT_LE(mean->zone->width_mm(), mean->deviation_mm);
  EXPECT_FALSE(mean->runout);
  EXPECT_TRUE(warned(*mean, core::Code::kNoAxis));
  EXPECT_FALSE(mean->effective_radius_mm());
}

TEST(Wheel, StatesRunoutOnlyWithTheSpindleAxisAndNeverOfAnEnvelope) {
  WheelOptions options;
  options.axis_mm = {12.02, -7.0};
  const auto m = measure_wheel(example_1(), options);
  ASSERT_TRUE(m) << m.error().what;
  ASSERT_TRUE(m->runout);
  EXPECT_NEAR(m->runout->fim_mm / core::kMicrometre, 35.393, 1.6e-3);
  EXPECT_NEAR(m->runout->effective_radius_mm, 50.017696, kDigit);
  EXPECT_FALSE(warned(*m, core::Code::kNoAxis));
  options.mode = WheelMode::kEnvelope;
  const auto refused = measure_wheel(example_1(), options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMeaning);
  options.axis_mm.reset();
  const auto envelope = measure_wheel(example_1(), options);
  ASSERT_TRUE(envelope);
  EXPECT_FALSE(envelope->runout);
  EXPECT_EQ(envelope->effective_radius_mm(), envelope->radius_mm);
}

TEST(Wheel, GivesEveryNumberOfWorkedExample2) {
  const auto all = measure_wheel(example_2(), plain());
  ASSERT_TRUE(all) << all.error().what;
  EXPECT_EQ(all->centers.accepted.size(), 495U);
  EXPECT_NEAR(all->centers.best_kappa(), 1.00, 5e-3);
  EXPECT_NEAR(all->centers.worst_kappa(), 4.00, 5e-3);
  EXPECT_NEAR(all->center_mm.x(), 0.495383, kDigit);
  EXPECT_NEAR(all->center_mm.y(), 0.256488, kDigit);
  EXPECT_NEAR(all->radius_mm, 75.017069, kDigit);
  EXPECT_NEAR(all->deviation_mm / core::kMicrometre, 54.399, 1.6e-3);
  EXPECT_NEAR(all->check.center_mm.x(), 0.495381, kDigit);
  EXPECT_NEAR(all->check.center_mm.y(), 0.256490, kDigit);

  const auto outliers = find_outliers(example_2(), all->centers.accepted);
  ASSERT_TRUE(outliers);
  EXPECT_NEAR(outliers->center_mm.x(), 0.499681, 2.0 * kDigit);
  EXPECT_NEAR(outliers->center_mm.y(), 0.250245, 2.0 * kDigit);
  EXPECT_NEAR(outliers->scale_mm / core::kMicrometre, 3.887, 3e-3);
  const std::array deviations = {4.53,  -0.24, -3.85, 0.24,  53.40, -2.05,
                                 -3.73, 2.63,  3.83,  -1.01, -2.62, 2.16};
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    EXPECT_NEAR(outliers->deviations_mm[i] / core::kMicrometre, deviations[i], 7e-3) << i;
  }

  WheelOptions options = plain();
  options.robust = true;
  const auto robust = measure_wheel(example_2(), options);
  ASSERT_TRUE(robust) << robust.error().what;
  ASSERT_EQ(robust->dropped.size(), 1U);
  EXPECT_EQ(robust->dropped.front().row, 4U);
  EXPECT_EQ(robust->centers.accepted.size(), 330U);
  EXPECT_NEAR(robust->center_mm.x(), 0.500561, kDigit);
  EXPECT_NEAR(robust->center_mm.y(), 0.248937, kDigit);
  EXPECT_NEAR(robust->radius_mm, 75.012475, kDigit);
  EXPECT_NEAR(robust->deviation_mm / core::kMicrometre, 7.965, 1.6e-3);
  EXPECT_NEAR(robust->check.center_mm.x(), 0.500655, kDigit);
  EXPECT_NEAR(robust->check.center_mm.y(), 0.248958, kDigit);
  EXPECT_NEAR(robust->check.radius_mm, 75.012471, kDigit);
  EXPECT_NEAR(robust->check.deviation_mm / core::kMicrometre, 7.906, 1.6e-3);
  EXPECT_NEAR(robust->center_scatter_mm / core::kMicrometre, 5.06, 6e-3);
  EXPECT_NEAR(robust->spread_mm / core::kMicrometre, 3.06, 6e-3);
  EXPECT_NEAR(robust->expected_scatter_mm / core::kMicrometre, 5.10, 6e-3);

  // The check beside least squares: the mean weighted by 1/kappa^2.
  options.mean = WheelMean::kLeastSquares;
  const auto weighted = measure_wheel(example_2(), options);
  ASSERT_TRUE(weighted);
  EXPECT_NEAR(weighted->quadruple_center_mm.x(), 0.500620, kDigit);
  EXPECT_NEAR(weighted->quadruple_center_mm.y(), 0.248949, kDigit);
}

TEST(Wheel, AmplifiesByTheFactorsOfTheArc) {
  struct Arc {
    double deg, center, radius, digit_center, digit_radius;
  };
  for (const Arc& arc :
       {Arc{20, 54.6, 54.2, .1, .1}, Arc{30, 24.4, 24.0, .1, .1}, Arc{60, 6.245, 5.9, .001, .1},
        Arc{90, 2.9, 2.5, .1, .1}, Arc{120, 1.7, 1.35, .1, .01}, Arc{180, 0.91, 0.56, .01, .01},
        Arc{360, 0.58, 0.29, .01, .01}}) {
    SCOPED_TRACE(arc.deg);
    const auto points = arc_points(12, arc.deg, 50.0, 0.0, 1);
    const auto factors = circle_factors(angular_order(points, {0.0, 0.0}).angles_rad);
    EXPECT_NEAR(factors.center, arc.center, 0.51 * arc.digit_center);
    EXPECT_NEAR(factors.radius, arc.radius, 0.51 * arc.digit_radius);
  }
}

struct Scatter {
  double center_um = 0.0;
  double radius_um = 0.0;
};

/// Root mean square errors of centre and radius over seeded runs: n = 12, R = 50, sigma = 2 um.
Scatter scatter_of(double arc_deg, WheelOptions options, int runs) {
  options.minimum_zone = false;
  double center = 0.0;
  double radius = 0.0;
  for (int run = 0; run < runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    options.quadruples.seed = 1000 + seed;
    const auto m = measure_wheel(arc_points(12, arc_deg, 50.0, 2e-3, seed), options);
    if (!m) {
      ADD_FAILURE() << m.error().what;
      return {};
    }
    center += m->center_mm.squaredNorm();
    radius += (m->radius_mm - 50.0) * (m->radius_mm - 50.0);
  }
  return {std::sqrt(center / runs) * 1e3, std::sqrt(radius / runs) * 1e3};
}

// n even angles: sigma_S = 2 / sqrt(n), a_R = 1 / sqrt(n), however often a row is given.
TEST(CircleFactors, CountARowThatIsGivenTwiceOnce) {
  std::vector<double> angles_rad;
  for (int i = 0; i < 16; ++i) angles_rad.insert(angles_rad.end(), 4, i * core::kTwoPi / 16.0);
  const CircleFactors factors = circle_factors(angles_rad);
  EXPECT_NEAR(factors.center, 0.5, 1e-12);
  EXPECT_NEAR(factors.radius, 0.25, 1e-12);
}

TEST(Wheel, ScattersAsTheTableOfTheMethodSays) {
  struct Row {
    double arc_deg, center_um, radius_um;
  };
  for (const Row& row : {Row{360, 1.11, 0.61}, Row{120, 3.6, 2.6}, Row{60, 12.1, 11.1}}) {
    SCOPED_TRACE(row.arc_deg);
    const Scatter found =
        scatter_of(row.arc_deg, plain(WheelMean::kAsPublished), test::full() ? 4000 : 1000);
    EXPECT_NEAR(found.center_um, row.center_um, 0.1 * row.center_um);
    EXPECT_NEAR(found.radius_um, row.radius_um, 0.1 * row.radius_um);
  }
}

TEST(Wheel, MovesTurnsAndGrowsWithItsPointsAndKnowsNoOrder) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const double arc = seed % 2 == 0 ? 360.0 : 110.0;
    const Points2 points = arc_points(9 + seed % 8, arc, 40.0, 2e-3, seed);
    const auto base = measure_wheel(points, {});
    ASSERT_TRUE(base) << base.error().what;
    core::KeyedNoise noise(seed, {5});
    const Eigen::Vector2d shift(500.0 * noise.normal(), 500.0 * noise.normal());
    const Eigen::Rotation2Dd turn(core::kTwoPi * noise.uniform());
    const double scale = 0.5 + noise.uniform();
    Points2 moved;
    for (const auto& p : points) moved.emplace_back(shift + scale * (turn * p));
    std::rotate(moved.begin(), moved.begin() + 3, moved.end());
    std::swap(moved[0], moved[4]);
    const auto other = measure_wheel(moved, {});
    ASSERT_TRUE(other) << other.error().what;
    const Eigen::Vector2d expected = shift + scale * (turn * base->center_mm);
    EXPECT_LT((other->center_mm - expected).norm(), 1e-9);
    EXPECT_NEAR(other->radius_mm, scale * base->radius_mm, 1e-9);
    EXPECT_NEAR(other->deviation_mm, scale * base->deviation_mm, 1e-10);
    EXPECT_NEAR(other->radius_uncertainty_mm, scale * base->radius_uncertainty_mm, 1e-10);
    EXPECT_EQ(other->centers.accepted.size(), base->centers.accepted.size());
  }
}

TEST(Wheel, FindsAnExactCircleExactlyAndHoldsItsUncertainty) {
  const auto exact = measure_wheel(arc_points(30, 200.0, 60.0, 0.0, 1, {5.0, -3.0}), {});
  ASSERT_TRUE(exact) << exact.error().what;
  EXPECT_LT((exact->center_mm - Eigen::Vector2d(5.0, -3.0)).norm(), 1e-9);
  EXPECT_NEAR(exact->radius_mm, 60.0, 1e-9);
  const int runs = test::full() ? 2000 : 300;
  int inside = 0;
  for (int run = 0; run < runs; ++run) {
    WheelOptions options;
    options.minimum_zone = false;
    const auto points = arc_points(16, 360.0, 50.0, 2e-3, 500 + static_cast<std::uint64_t>(run));
    const auto m = measure_wheel(points, options);
    ASSERT_TRUE(m);
    inside += std::abs(m->radius_mm - 50.0) <= 2.0 * m->radius_uncertainty_mm ? 1 : 0;
  }
  EXPECT_GT(inside, runs * 90 / 100);
  EXPECT_LT(inside, runs * 995 / 1000);
}

/// Root mean squares of the errors of centre and radius over their stated uncertainties.
struct Stated {
  double center = 0.0;
  double radius = 0.0;
};

Stated stated(std::size_t n, double arc_deg, WheelOptions options, int runs) {
  options.minimum_zone = false;
  Stated out;
  for (int run = 0; run < runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    options.quadruples.seed = 9000 + seed;
    const auto m = measure_wheel(arc_points(n, arc_deg, 50.0, 2e-3, 900 + seed), options);
    if (!m) {
      ADD_FAILURE() << m.error().what;
      return {};
    }
    out.center += std::pow(m->center_mm.norm() / m->center_uncertainty_mm, 2) / runs;
    out.radius += std::pow((m->radius_mm - 50.0) / m->radius_uncertainty_mm, 2) / runs;
  }
  return {std::sqrt(out.center), std::sqrt(out.radius)};
}

TEST(Wheel, StatesTheUncertaintyOfTheCentreItGives) {
  struct Row {
    std::size_t points;
    WheelMean mean;
  };
  const std::size_t many = test::full() ? 20000 : 2000;
  for (const Row& row : {Row{16, WheelMean::kLeastSquares}, Row{100, WheelMean::kLeastSquares},
                         Row{many, WheelMean::kLeastSquares}, Row{16, WheelMean::kAsPublished},
                         Row{2000, WheelMean::kAsPublished}}) {
    for (const double arc_deg : {360.0, 120.0}) {
      SCOPED_TRACE(::testing::Message()
                   << row.points << " points, " << arc_deg << " deg, " << name_of(row.mean));
      const Stated found = stated(row.points, arc_deg, plain(row.mean),
                                  row.points > 1000 ? 60 : test::cases(200, 600));
      const double slack = row.points > 1000 ? 0.25 : 0.15;
      std::printf("%6zu points, %3.0f deg, %s: centre %.2f, radius %.2f\n", row.points, arc_deg,
                  std::string(name_of(row.mean)).c_str(), found.center, found.radius);
      EXPECT_NEAR(found.center, 1.0, slack);
      EXPECT_NEAR(found.radius, 1.0, slack);
    }
  }
}

TEST(Wheel, NamesGrossPointsThatItKeeps) {
  const auto m = measure_wheel(example_2(), {});
  ASSERT_TRUE(m) << m.error().what;
  EXPECT_TRUE(m->dropped.empty());
  const auto found = std::find_if(m->warnings.begin(), m->warnings.end(), [](const core::Error& w) {
    return w.code == core::Code::kOutliers;
  });
  ASSERT_NE(found, m->warnings.end());
  EXPECT_THAT(found->what, HasSubstr("1 of 12 points"));
  EXPECT_THAT(found->what, HasSubstr("4 (+53."));
  EXPECT_FALSE(warned(*measure_wheel(example_1(), {}), core::Code::kOutliers));
  Points2 many = arc_points(9, 360.0, 50.0, 5e-4, 2);
  many[0] *= 1.002;
  many[4] *= 1.002;
  EXPECT_TRUE(warned(*measure_wheel(many, {}), core::Code::kOutliers));
}

TEST(Wheel, KeepsAWornSectorAndDropsALoneChip) {
  Points2 points = arc_points(36, 360.0, 50.0, 1e-3, 9);
  for (std::size_t i = 10; i < 15; ++i) points[i] *= (50.0 - 0.03) / 50.0;
  points[25] *= 50.2 / 50.0;
  WheelOptions options;
  options.robust = true;
  const auto m = measure_wheel(points, options);
  ASSERT_TRUE(m) << m.error().what;
  ASSERT_EQ(m->dropped.size(), 1U);
  EXPECT_EQ(m->dropped.front().row, 25U);
  EXPECT_TRUE(warned(*m, core::Code::kLocalForm));
  EXPECT_TRUE(warned(*m, core::Code::kOutliers));
  EXPECT_TRUE(warned(*m, core::Code::kCorrelated));
  EXPECT_GT(m->deviation_mm, 0.028);
}

core::Error refused(const Points2& points, const WheelOptions& options = {}) {
  const auto m = measure_wheel(points, options);
  if (m) ADD_FAILURE() << "accepted";
  return m ? core::Error{} : m.error();
}

TEST(Wheel, RefusesPointsThatAreNoWheel) {
  using core::Code;
  const Points2 good = arc_points(12, 360.0, 50.0, 1e-3, 1);
  EXPECT_EQ(refused({good.begin(), good.begin() + 7}).code, Code::kTooFewPoints);
  EXPECT_EQ(refused({}).code, Code::kTooFewPoints);
  Points2 same = {good.begin(), good.begin() + 6};
  for (int i = 0; i < 6; ++i) same.push_back(good[0]);
  const auto few = refused(same);
  EXPECT_EQ(few.code, Code::kTooFewPoints);
  EXPECT_THAT(few.what, HasSubstr("6 of 12 points"));
  Points2 bad = good;
  bad[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(bad).code, Code::kNotFinite);
  EXPECT_THAT(refused(bad).what, HasSubstr("point 7"));
  Points2 line;
  for (int i = 0; i < 10; ++i) line.emplace_back(i, 2.0 * i);
  EXPECT_EQ(refused(line).code, Code::kCollinear);
  EXPECT_EQ(refused(arc_points(12, 15.0, 50.0, 1e-4, 1)).code, Code::kShortArc);
  Points2 flat = example_2();  // seen from the centre of its circle it has no width at all
  for (auto& point : flat) point.x() *= 1e-3;
  EXPECT_EQ(refused(flat).code, Code::kShortArc);
  EXPECT_THAT(refused(flat).what, HasSubstr("they do not determine the centre"));
  const auto um = refused(arc_points(12, 360.0, 50000.0, 1.0, 1));
  EXPECT_EQ(um.code, Code::kUnits);
  EXPECT_THAT(um.what, HasSubstr("um"));
  EXPECT_EQ(refused(arc_points(12, 360.0, 0.05, 1e-6, 1)).code, Code::kUnits);
  WheelOptions options;
  options.nominal_radius_mm = 100.0;
  EXPECT_EQ(refused(good, options).code, Code::kOutOfRange);
  options = {};
  options.outliers.scales = 3.0;
  options.robust = true;
  EXPECT_EQ(refused(good, options).code, Code::kBadOption);
  options = {};
  options.quadruples.kappa_limit = 1.0;
  const auto centers = refused(arc_points(12, 100.0, 50.0, 1e-3, 1), options);
  EXPECT_EQ(centers.code, Code::kTooFewCenters);
  EXPECT_THAT(centers.what, HasSubstr("kappa above 1"));
}

TEST(Wheel, EvaluatesAShortArcWhenToldToAndWarns) {
  WheelOptions options;
  options.allow_short_arc = true;
  const auto m = measure_wheel(arc_points(12, 15.0, 50.0, 1e-4, 1), options);
  ASSERT_TRUE(m) << m.error().what;
  EXPECT_TRUE(warned(*m, core::Code::kShortArc));
  EXPECT_NEAR(m->order.coverage_rad() / core::kDegree, 15.0, 0.5);
}

TEST(Wheel, RefusesTooManyOutliers) {
  // Without the two chips seven points would stay.
  Points2 points = arc_points(9, 360.0, 50.0, 5e-4, 2);
  points[0] *= 1.002;
  points[4] *= 1.002;
  WheelOptions options;
  options.robust = true;
  EXPECT_EQ(refused(points, options).code, core::Code::kOutliers);
}

TEST(Wheel, TakesFiveThousandDrawnQuadruplesOfManyPoints) {
  const auto points = arc_points(200, 300.0, 80.0, 2e-3, 4);
  const auto a = measure_wheel(points, plain(WheelMean::kAsPublished));
  const auto b = measure_wheel(points, plain(WheelMean::kAsPublished));
  ASSERT_TRUE(a && b);
  const auto& c = a->centers;
  EXPECT_EQ(c.accepted.size() + c.short_chord + c.parallel_chords + c.ill_conditioned, 5000U);
  EXPECT_EQ(a->center_mm, b->center_mm);
  EXPECT_LT((a->center_mm - a->check.center_mm).norm(), 1e-3);
}

}  // namespace
}  // namespace rondure::fit
