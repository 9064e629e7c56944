// Rotary axes, sections 2 to 4 of the method specification: published matrices, setups of balls,
// and the errors of one station against independent solvers.
#include "fit/rotary/ball_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/decompositions.h"
#include "fit/least_squares/sphere.h"
#include "fit/rotary/axes.h"
#include "fit/rotary/ball_center.h"
#include "fit/rotary/internal/station.h"
#include "tests/fit/rotary_cases.h"
#include "tests/fit/spec_cases.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::angles_deg;
using test::circle_of;
using test::draw;
using test::error_matrix;
using test::example;
using test::example_balls;
using test::five_balls;
using test::fixture_errors;
using test::hanging;
using test::kA;
using test::kC;
using test::kDeg45;
using test::kUm;
using test::kUrad;
using test::letters;
using test::measured;
using test::no_errors;
using test::station_at;
using test::turned;
using ::testing::HasSubstr;

// ---- Section 2: model and published matrices.

constexpr double kRank = 1e-14;  // of the largest pivot

TEST(PublishedAxes, AreTheModelAtEveryAngleWithTheLostSignRestored) {
  const PublishedSetups s = {150.0, 260.0, 50.0, 170.0};
  for (int i = 0; i < 72; ++i) {
    const double angle = 5.0 * i * kDegree;
    SCOPED_TRACE(i);
    const auto c = s.of_c();
    const auto a = s.of_a();
    const auto of_c = error_matrix(turned({c.begin(), c.end()}, kC, angle));
    const auto of_a = error_matrix(turned({a.begin(), a.end()}, kA, angle));
    EXPECT_LT((published_c_matrix(s, angle) - of_c).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((published_a_matrix(s, angle) - of_a).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(core::column_space(published_c_matrix(s, angle), kRank).cols(), 6);
    EXPECT_EQ(core::column_space(published_a_matrix(s, angle), kRank).cols(), 6);
  }
}

TEST(PublishedAxes, AreOfDifferentSetups) {
  const PublishedSetups s = {150.0, 250.0, 50.0, 150.0};
  EXPECT_EQ(s.of_c()[2], Vector3d(0.0, 50.0, -250.0));   // (L2, H1)
  EXPECT_EQ(s.of_a()[2], Vector3d(0.0, 150.0, -250.0));  // (L2, H2)
}

// The entry of row Y, column al lost its operator; read as it stands it is a product.
TEST(PublishedAxes, AMatrixAsPrintedGivesWrongErrors) {
  const PublishedSetups s = {150.0, 250.0, 50.0, 150.0};
  Vector6 x;
  x << 5 * kUm, -8 * kUm, 3 * kUm, 30 * kUrad, -20 * kUrad, 10 * kUrad;
  for (const double deg : {0.0, 30.0, 60.0, 90.0}) {
    SCOPED_TRACE(deg);
    const auto balls = s.of_a();
    const auto p = turned({balls.begin(), balls.end()}, kA, deg * kDegree);
    const Eigen::VectorXd dp = error_matrix(p) * x;
    const auto error_by = [&](const PublishedMatrix& m) {
      return Vector6(core::solve_pivoted_qr(m, dp) - x);
    };
    const PublishedMatrix restored = published_a_matrix(s, deg * kDegree);
    EXPECT_LT(error_by(restored).norm(), 1e-15);
    PublishedMatrix printed = restored;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3d& ball = balls[static_cast<std::size_t>(k)];
      const double product =
          -ball.y() * std::sin(deg * kDegree) * -ball.z() * std::cos(deg * kDegree);
      EXPECT_NE(printed(3 * k + 1, 3), product);
      printed(3 * k + 1, 3) = product;
    }
    EXPECT_GT(error_by(printed).head<3>().norm(), 0.5 * kUm);
  }
}

/// Largest error of one linear solution over directions of w, its largest component `size`.
std::array<double, 2> linearisation_error(double size) {
  std::array<double, 2> out = {0.0, 0.0};
  core::KeyedNoise random(3, {1});
  for (const auto& balls : {example_balls(), hanging({{150, 50}, {150, 150}, {250, 150}}),
                            hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}})}) {
    for (int i = 0; i < 400; ++i) {
      Vector3d w = draw(random, 1.0);
      if (i < 27) w = Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (w.norm() == 0.0) continue;
      w *= size / w.cwiseAbs().maxCoeff();
      const auto m = error_matrix(balls);
      Eigen::VectorXd dp(m.rows());
      for (std::size_t k = 0; k < balls.size(); ++k) {
        dp.segment<3>(3 * static_cast<Eigen::Index>(k)) =
            error_motion(Vector3d::Zero(), w) * balls[k] - balls[k];
      }
      const Vector6 x = core::solve_pivoted_qr(m, dp);
      out[0] = std::max(out[0], x.head<3>().cwiseAbs().maxCoeff() / kUm);
      out[1] = std::max(out[1], (x.tail<3>() - w).cwiseAbs().maxCoeff() / kUrad);
    }
  }
  return out;
}

TEST(RotaryAxes, LinearisationErrorIsThatOfTheSpecification) {
  const auto small = linearisation_error(1e-4);
  EXPECT_NEAR(small[0], 0.0025, 0.0003);
  EXPECT_NEAR(small[1], 0.005, 0.0003);
  const auto middle = linearisation_error(1e-3);
  EXPECT_NEAR(middle[0], 0.25, 0.03);
  EXPECT_NEAR(middle[1], 0.5, 0.03);
  const auto large = linearisation_error(5e-3);
  EXPECT_NEAR(large[0], 6.2, 0.6);
  EXPECT_NEAR(large[1], 12.6, 0.6);
}

// ---- Section 3: rank, condition, choice of balls.

/// The station at one angle, of exact balls with u = 1 um against an exact reference.
RotaryStation solved(const std::vector<Vector3d>& balls, const RotaryAxis& axis = kC,
                     double angle_rad = 0.0) {
  const auto m =
      measured(axis, balls, {angle_rad}, no_errors, {.u_mm = kUm, .noisy = false, .references = 0});
  return identify_rotary_axis(m).value().stations.front();
}

/// Covariance of (t; w) for u = 1 mm.
Matrix6 covariance_per_u2(const RotaryStation& station) {
  return station.errors.covariance / (kUm * kUm);
}

/// u(t)/u, and u(w)/u in urad per um.
Vector6 u_per_u(const RotaryStation& station) {
  Vector6 out = covariance_per_u2(station).diagonal().cwiseSqrt();
  out.tail<3>() *= kUm / kUrad;
  return out;
}

/// Condition of equation (1) at the origin with rotations scaled by 100 mm, from the covariance,
/// whose square roots of eigenvalues are the reciprocals of the singular values.
double condition_at_origin(const RotaryStation& station) {
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, 100.0, 100.0, 100.0;
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * covariance_per_u2(station) * scale.asDiagonal();
  const Vector6 e =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(e(5) / e(0));
}

TEST(BallSetup, GivesTheTableOfTheSpecification) {
  struct Row {
    const char* name;
    std::vector<Vector3d> balls;
    double condition;
    std::array<double, 6> u_per_u;
  };
  const double h = std::sqrt(3.0) / 2.0 * 100.0;
  const std::vector<Row> rows = {
      {"L2 H1", example_balls(), 15.3, {3.39, 1.69, 0.92, 8.66, 14.14, 14.14}},
      {"L2 H2",
       hanging({{150, 50}, {150, 150}, {250, 150}}),
       11.2,
       {2.35, 1.69, 1.16, 8.66, 14.14, 14.14}},
      {"rectangle",
       hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}}),
       12.6,
       {2.29, 1.50, 0.87, 7.07, 10.00, 10.00}},
      {"close",
       hanging({{150, 50}, {150, 70}, {170, 50}}),
       53.9,
       {13.5, 6.81, 2.52, 43.3, 70.7, 70.7}},
      {"from the axis",
       hanging({{150, 0}, {150, 100}, {250, 0}}),
       12.7,
       {2.92, 1.69, 0.65, 8.66, 14.14, 14.14}},
      {"wide",
       hanging({{100, 0}, {100, 200}, {300, 0}}),
       7.3,
       {1.58, 0.92, 0.65, 4.33, 7.07, 7.07}},
      {"near",
       hanging({{50, 50}, {50, 150}, {150, 50}}),
       7.7,
       {2.12, 0.92, 0.92, 8.66, 14.14, 14.14}},
      {"far",
       hanging({{450, 250}, {450, 350}, {550, 250}}),
       95.9,
       {9.51, 4.23, 2.52, 8.66, 14.14, 14.14}},
      {"three round the axis",
       {{100, 0, 0}, {-50, h, 0}, {-50, -h, 0}},
       1.41,
       {0.58, 0.58, 0.58, 8.16, 8.16, 5.77}},
      {"four",
       {{100, 0, 50}, {-100, 0, 50}, {0, 100, -50}, {0, -100, -50}},
       1.15,
       {0.50, 0.50, 0.50, 5.77, 5.77, 5.00}},
      {"six",
       {{100, 0, 0}, {-100, 0, 0}, {0, 100, 0}, {0, -100, 0}, {0, 0, 100}, {0, 0, -100}},
       1.22,
       {0.41, 0.41, 0.41, 5.00, 5.00, 5.00}}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const RotaryStation station = solved(row.balls);
    EXPECT_NEAR(condition_at_origin(station), row.condition, row.condition < 2.0 ? 0.0051 : 0.05);
    const Vector6 u = u_per_u(station);
    const bool coarse = row.u_per_u[3] > 20.0;  // "close": numbers above 10 have one decimal
    for (int k = 0; k < 6; ++k) {
      const double printed = row.u_per_u[static_cast<std::size_t>(k)];
      EXPECT_NEAR(u(k), printed, coarse && printed > 10.0 ? 0.05 : 0.0051) << k;
    }
  }
}

// R-1 of analyses_uncertainty 13.
TEST(BallSetup, RectangleHasTheDigitsOfTheWorkedCase) {
  const Vector6 u = u_per_u(solved(hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}})));
  Vector6 printed;
  printed << 2.291288, 1.5, 0.866025, 7.071068, 10.0, 10.0;
  EXPECT_LT((u - printed).cwiseAbs().maxCoeff(), 5.1e-7) << u.transpose();
}

TEST(BallSetup, OfTheAAxisGivesTheNumbersOfTheWorkedExample) {
  const auto balls = hanging({{150, 50}, {150, 150}, {250, 150}});
  for (const double angle : angles_deg(0, 90, 10))
    EXPECT_NEAR(condition_at_origin(solved(balls, kA, angle)), 11.15, 0.0051);
  const auto u = [&](double angle_rad) { return u_per_u(solved(balls, kA, angle_rad)); };
  const auto off = [](const Vector3d& found, const Vector3d& printed) {
    return (found - printed).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(off(u(0.0).head<3>(), {2.35, 1.69, 1.16}), 0.0051);
  EXPECT_LT(off(u(kDeg45).head<3>(), {2.35, 0.71, 1.93}), 0.0051);
  EXPECT_LT(off(u(2.0 * kDeg45).head<3>(), {2.35, 1.16, 1.69}), 0.0051);
  EXPECT_LT(off(u(kDeg45).tail<3>(), {8.66, 17.3, 10.0}), 0.051);
}

/// Equation (2): covariance of (t; w) at the origin for u = 1 mm.
Matrix6 equation_two(const std::vector<Vector3d>& p) {
  const auto n = static_cast<double>(p.size());
  Vector3d centroid = Vector3d::Zero();
  for (const Vector3d& one : p) centroid += one / n;
  Matrix3d m = Matrix3d::Zero();
  for (const Vector3d& one : p) {
    const Vector3d q = one - centroid;
    m += q.squaredNorm() * Matrix3d::Identity() - q * q.transpose();
  }
  const Matrix3d inverse = m.inverse();
  const Matrix3d lever = cross_matrix(centroid);
  Matrix6 out;
  out << Matrix3d::Identity() / n - lever * inverse * lever, lever * inverse, -inverse * lever,
      inverse;
  return out;
}

TEST(BallSetup, StationsHaveTheCovarianceOfEquationTwo) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {9});
    std::vector<Vector3d> p0;
    for (std::uint64_t i = 0; i < 3 + seed % 4; ++i) p0.push_back(draw(random, 150.0));
    const double angle = core::kTwoPi * random.uniform();
    const auto p = turned(p0, kC, angle);
    const RotaryStation station = solved(p0, kC, angle);
    const Matrix6 covariance = covariance_per_u2(station);
    const Matrix6 expected = equation_two(p);
    const Vector6 scale = expected.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix6 off = scale.asDiagonal() * (covariance - expected) * scale.asDiagonal();
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-8);
    double sum = 0.0;
    for (const Vector3d& r : station.redundancy) sum += r.sum();
    EXPECT_NEAR(sum, station.dof, 1e-9);
    EXPECT_EQ(station.dof, 3 * static_cast<int>(p.size()) - 6);
    // At a point s the uncertainty of t is that with the origin there.
    const Vector3d s = draw(random, 100.0);
    std::vector<Vector3d> from_s;
    for (const Vector3d& one : p) from_s.emplace_back(one - s);
    const Matrix3d at_s = equation_two(from_s).topLeftCorner<3, 3>();
    EXPECT_LT((point_covariance_mm2(covariance, s) - at_s).norm(), 1e-9 * at_s.norm());
  }
}

TEST(BallSetup, SpreadAloneDeterminesTheRotations) {
  const auto expect_rotations = [](const std::vector<std::array<double, 2>>& setups,
                                   const Vector3d& expected) {
    const Vector3d w = covariance_per_u2(solved(hanging(setups))).diagonal().tail<3>().cwiseSqrt();
    EXPECT_LT((w - expected).cwiseAbs().maxCoeff(), 1e-12);
  };
  for (const double dl : {40.0, 100.0, 160.0}) {
    for (const double dh : {30.0, 100.0}) {
      SCOPED_TRACE(::testing::Message() << dl << ", " << dh);
      // Normal to the plane of the balls (x), radial direction (y), line of the axis (z).
      const Vector3d rectangle(1.0 / std::hypot(dh, dl), 1.0 / dl, 1.0 / dh);
      const Vector3d three(std::sqrt(1.5) * rectangle.x(), std::sqrt(2.0) * rectangle.y(),
                           std::sqrt(2.0) * rectangle.z());
      for (const double third : {50.0, 50.0 + dh})
        expect_rotations({{150, 50}, {150, 50 + dh}, {150 + dl, third}}, three);
      expect_rotations({{150, 50}, {150, 50 + dh}, {150 + dl, 50}, {150 + dl, 50 + dh}}, rectangle);
    }
  }
}

TEST(BallSetup, ScaledConditionDoesNotKnowDistanceOrUnit) {
  EXPECT_NEAR(setup_condition(example_balls()), 2.0, 1e-12);
  EXPECT_NEAR(setup_condition(hanging({{450, 250}, {450, 350}, {550, 250}})), 2.0, 1e-12);
  EXPECT_NEAR(setup_condition(hanging({{0.1, 0.2}, {0.1, 0.3}, {0.2, 0.2}})), 2.0, 1e-12);
  const auto square = hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}});
  EXPECT_NEAR(setup_condition(square), std::sqrt(2.0), 1e-12);
}

TEST(BallSetup, RefusesALineAndNamesTheBallThatCuresIt) {
  const auto line = hanging({{150, 50}, {150, 150}, {150, 100}});
  EXPECT_TRUE(std::isinf(setup_condition(line)));
  for (const bool nearly : {false, true}) {
    auto balls = line;
    if (nearly) balls[2].x() += 0.5;
    const auto refused = check_setup(balls, letters(3));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::kCollinear);
    const std::string& what = refused.error().what;
    const std::string said = "off the line through a and b, at least ";
    ASSERT_THAT(what, HasSubstr(said));
    const double distance = std::stod(what.substr(what.find(said) + said.size()));
    auto cured = balls;
    cured.push_back(Vector3d(distance, 100.0, -150.0));
    EXPECT_TRUE(check_setup(cured, letters(4)));
    EXPECT_LE(setup_condition(cured), kConditionWarning);
    cured.back().x() = 0.8 * distance;
    EXPECT_GT(setup_condition(cured), kConditionWarning);
  }
  std::vector<Vector3d> exact;
  for (const double x : {0.0, 100.0, 200.0}) exact.emplace_back(x, 0.0, 0.0);
  EXPECT_THAT(check_setup(exact, letters(3)).error().what, HasSubstr("condition without a bound"));
  const auto two = check_setup(hanging({{150, 50}, {150, 150}}), letters(2));
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, Code::kTooFewPoints);
  EXPECT_THAT(two.error().what, HasSubstr("add a ball off the line through a and b"));
  EXPECT_FALSE(check_setup({}, {}));
  const std::vector<Vector3d> one_place(3, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(check_setup(one_place, letters(3)).error().code, Code::kCollinear);
}

/// Uncertainty of the centre of a unit ball from touches of unit deviation: what a fit makes of a
/// small deviation of each.
template <class Fit>
Vector3d centre_uncertainty(const std::vector<Vector3d>& touches, const Fit& fit) {
  constexpr double kDeviation = 1e-6;
  Vector3d squares = Vector3d::Zero();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    std::vector<Vector3d> moved = touches;
    moved[i] *= 1.0 + kDeviation;
    squares += Vector3d(fit(moved) / kDeviation).cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

TEST(BallSetup, BallCentresFromTouchesAreAsUncertainAsTheSpecificationSays) {
  const auto spiral = [](int n, double lowest) {
    std::vector<Vector3d> out;
    for (int i = 0; i < n; ++i) {
      const double z = 1.0 - (1.0 - lowest) * (i + 0.5) / n;
      const double r = std::sqrt(1.0 - z * z);
      const double a = i * core::kTwoPi * 0.618033988749895;
      out.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
    return out;
  };
  const auto radius_fitted = [](const auto& touches) {
    return ls_sphere(touches).value().center_mm;
  };
  const auto radius_held = [](const auto& touches) {
    return ball_center(touches, 1.0).value().center_mm;
  };
  const Vector3d whole = centre_uncertainty(spiral(400, -1.0), radius_fitted);
  EXPECT_LT((whole - Vector3d::Constant(std::sqrt(3.0 / 400.0))).norm(), 0.002);
  // 25 points of a hemisphere; how they are spread moves the second digit.
  const Vector3d fitted = centre_uncertainty(spiral(25, 0.0), radius_fitted);
  EXPECT_LT((fitted - Vector3d(0.34, 0.35, 0.69)).cwiseAbs().maxCoeff(), 0.02);
  const Vector3d held = centre_uncertainty(spiral(25, 0.0), radius_held);
  EXPECT_LT((held - Vector3d(0.34, 0.35, 0.35)).cwiseAbs().maxCoeff(), 0.02);
}

// ---- Section 4: solver, redundancy, outliers.

TEST(RotaryStation, RedundancyNumbersAreThoseOfTheSpecification) {
  const std::array<Vector3d, 3> expected = {
      {{0.29, 0.29, 0.58}, {0.29, 0.29, 0.33}, {0.17, 0.17, 0.58}}};
  const auto study = identify_rotary_axis(example({.references = 0}));
  ASSERT_TRUE(study) << study.error().what;
  const RotaryStation& station = station_at(*study, 45.0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT((station.redundancy[i] - expected[i]).cwiseAbs().maxCoeff(), 0.0051) << i;
  EXPECT_EQ(station.dof, 3);
  for (const Vector3d& r : station_at(*study, 0.0).redundancy) EXPECT_NEAR(r.x(), 0.0, 1e-12);
  for (const Vector3d& r : station_at(*study, 90.0).redundancy) EXPECT_NEAR(r.y(), 0.0, 1e-12);
  const auto square = hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}});
  for (const Vector3d& r : solved(square, kC, kDeg45).redundancy)
    EXPECT_LT((r - Vector3d(0.44, 0.44, 0.62)).cwiseAbs().maxCoeff(), 0.0051);
  for (const Vector3d& r : solved(square).redundancy)
    EXPECT_LT((r - Vector3d(0.25, 0.62, 0.62)).cwiseAbs().maxCoeff(), 0.0051);
}

TEST(RotaryStation, AnOutlierOfThreeIsDetectedButNotLocated) {
  auto m = example({.noisy = false, .references = 0});
  auto& poses = m.stations;
  const auto at = std::find_if(poses.begin(), poses.end(), [](const RotaryPose& pose) {
    return std::abs(pose.angle_rad - kDeg45) < 1e-9;
  });
  at->balls[0].centre_mm += Vector3d(0.0, 0.0, 5.0 * kUm);
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  const RotaryStation& station = station_at(*study, 45.0);
  // (5/0.5)^2 times the redundancy 0.58 without noise; the example of the specification, with
  // noise, has 31 for another coordinate.
  EXPECT_NEAR(station.chi2, 100.0 * station.redundancy[0].z(), 0.01);
  EXPECT_GT(station.chi2, station.chi2_limit);
  EXPECT_TRUE(station.flagged);
  EXPECT_TRUE(station.removed.empty());
  at->balls[0].centre_mm -= Vector3d(0.0, 0.0, 5.0 * kUm);
  at->balls[0].centre_mm += Vector3d(5.0 * kUm, 0.0, 0.0);
  const auto other = identify_rotary_axis(m);
  EXPECT_NEAR(station_at(*other, 45.0).chi2, 29.0, 2.5);  // "chi2 = 31" with its noise
}

TEST(RotaryStation, AnOutlierOfFiveIsFoundAndLeftOut) {
  int found = 0;
  int false_alarms = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    auto m = measured(kA, five_balls(), angles_deg(-90, 90, 13), fixture_errors, {.seed = seed});
    const std::size_t wrong = seed % 5;
    m.stations[4].balls[wrong].centre_mm += 12.0 * kUm * Vector3d(0.6, -0.64, 0.48);
    const auto study = identify_rotary_axis(m);
    ASSERT_TRUE(study) << study.error().what;
    const RotaryStation& station = study->stations[4];
    if (station.removed == std::vector<std::string>{letters(5)[wrong]}) ++found;
    EXPECT_FALSE(station.flagged);
    for (std::size_t i = 0; i < study->stations.size(); ++i)
      if (i != 4 && !study->stations[i].removed.empty()) ++false_alarms;
    EXPECT_LT((station.errors.values() - fixture_errors(station.angle_rad))
                  .cwiseQuotient(station.errors.sigma())
                  .cwiseAbs()
                  .maxCoeff(),
              5.0);
  }
  EXPECT_GE(found, 39);
  EXPECT_LE(false_alarms, 4);  // 480 stations at 0.001
}

TEST(RotaryStation, SolvesTheExactModelForAnySizeOfError) {
  for (const double size : {100e-6, 1e-3, 5e-3, 0.03}) {
    SCOPED_TRACE(size);
    const auto truth = [&](double phi) {
      Vector6 out = fixture_errors(phi);
      out.tail<3>() += size * (1.0 - std::cos(phi)) * Vector3d(0.4, -1.0, 0.7);
      return out;
    };
    const auto m = measured(kC, example_balls(), circle_of(8), truth,
                            {.u_mm = 1e-3, .noisy = false, .references = 0});
    const auto study = identify_rotary_axis(m);
    ASSERT_TRUE(study) << study.error().what;
    for (const RotaryStation& station : study->stations) {
      const Vector6 left = station.errors.values() - truth(station.angle_rad);
      EXPECT_LT(left.tail<3>().norm(), 1e-14);
      EXPECT_LT(left.head<3>().norm(), 1e-11);
    }
  }
}

/// Rotation by the quaternion method of Horn (1987), unit weights.
Matrix3d horn(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  Vector3d a = Vector3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / static_cast<double>(from.size());
    b += to[i] / static_cast<double>(from.size());
  }
  Matrix3d s = Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) s += (from[i] - a) * (to[i] - b).transpose();
  const Vector3d v(s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
  Eigen::Matrix4d n;
  n << s.trace(), v.transpose(), v, s + s.transpose() - s.trace() * Matrix3d::Identity();
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
}

TEST(RotaryStation, AgreesWithTheQuaternionMethod) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto m = measured(kA, five_balls(), angles_deg(-90, 90, 5), fixture_errors,
                            {.u_mm = 2e-3, .seed = seed, .references = 0});
    const auto study = identify_rotary_axis(m, {.remove_outliers = false});
    ASSERT_TRUE(study);
    for (std::size_t k = 0; k < m.stations.size(); ++k) {
      std::vector<Vector3d> to;
      for (const BallCentre& ball : m.stations[k].balls) to.push_back(ball.centre_mm);
      const auto from = turned(five_balls(), kA, m.stations[k].angle_rad);
      const Vector3d w = rotation_vector(horn(from, to));
      EXPECT_LT((w - study->stations[k].errors.w_rad).norm(), 1e-12);
    }
  }
}

// Equation (1) as dense weighted least squares, linearised again until it stands.
Vector6 iterated(const std::vector<Vector3d>& p, const RotaryPose& pose,
                 const std::vector<Vector3d>& reference_u, const Matrix3d& turn) {
  const auto n = static_cast<Eigen::Index>(p.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Matrix3d own = Vector3d(pose.balls[k].u_mm.cwiseAbs2()).asDiagonal();
    const Matrix3d reference = Vector3d(reference_u[k].cwiseAbs2()).asDiagonal();
    covariance.block<3, 3>(3 * i, 3 * i) = own + turn * reference * turn.transpose();
  }
  const Eigen::MatrixXd weight = core::inverse_lu(covariance);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int pass = 0; pass < 30; ++pass) {
    std::vector<Vector3d> here;
    Eigen::VectorXd dp(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      here.emplace_back(motion * p[static_cast<std::size_t>(i)]);
      dp.segment<3>(3 * i) = pose.balls[static_cast<std::size_t>(i)].centre_mm - here.back();
    }
    const Eigen::MatrixXd a = error_matrix(here);
    const Eigen::VectorXd right = a.transpose() * weight * dp;
    const Vector6 x = core::solve_pivoted_qr(a.transpose() * weight * a, right);
    motion = error_motion(x.head<3>(), x.tail<3>()) * motion;
  }
  Vector6 out;
  out << motion.translation(), rotation_vector(motion.linear());
  return out;
}

TEST(RotaryStation, AgreesWithIteratedLinearLeastSquaresForUnequalUncertainties) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    auto m = measured(kA, five_balls(), angles_deg(-90, 90, 5), fixture_errors,
                      {.u_mm = 2e-3, .seed = seed, .references = 1});
    core::KeyedNoise random(seed, {33});
    const auto unequal = [&] {
      return Vector3d(Vector3d::Constant(2.5e-3) + draw(random, 1.5e-3));
    };
    std::vector<Vector3d> reference_u;
    for (BallCentre& ball : m.references[0]) reference_u.push_back(ball.u_mm = unequal());
    for (RotaryPose& pose : m.stations)
      for (BallCentre& ball : pose.balls) ball.u_mm = unequal();
    const auto study = identify_rotary_axis(m, {.remove_outliers = false});
    ASSERT_TRUE(study);
    std::vector<Vector3d> p0;
    for (const BallCentre& ball : m.references[0]) p0.push_back(ball.centre_mm);
    for (std::size_t k = 0; k < m.stations.size(); ++k) {
      const Matrix3d turn = kA.turn(m.stations[k].angle_rad);
      const Vector6 other =
          iterated(turned(p0, kA, m.stations[k].angle_rad), m.stations[k], reference_u, turn);
      EXPECT_LT((other - study->stations[k].errors.values()).tail<3>().norm(), 1e-12);
      EXPECT_LT((other - study->stations[k].errors.values()).head<3>().norm(), 1e-10);
    }
  }
}

TEST(RotaryAxes, DoesWithoutAMissingBallAndBridgesAStationWithTooFew) {
  auto m = measured(kA, five_balls(), angles_deg(-90, 90, 13), fixture_errors, {.seed = 4});
  m.stations[2].balls.erase(m.stations[2].balls.begin());
  m.stations[6].balls.resize(2);
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study) << study.error().what;
  EXPECT_EQ(study->stations[2].balls.size(), 4U);
  EXPECT_FALSE(study->stations[2].undetermined);
  EXPECT_TRUE(study->stations[6].undetermined);
  ASSERT_EQ(study->table.missing_rad.size(), 1U);
  const auto model = RotaryModel::of(study->table);
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->at(0.0)->bridged);
  EXPECT_TRUE(model->at(10.0 * kDegree)->bridged);
  EXPECT_FALSE(model->at(15.0 * kDegree)->bridged);
  EXPECT_FALSE(model->at(20.0 * kDegree)->bridged);
  EXPECT_LT((model->at(0.0)->values() - fixture_errors(0.0)).head<3>().norm(), 3.0 * kUm);
  EXPECT_TRUE(std::any_of(study->warnings.begin(), study->warnings.end(),
                          [](const auto& w) { return w.code == Code::kRank; }));
}

}  // namespace
}  // namespace rondure::fit
