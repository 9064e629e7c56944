// Six errors of a rotary axis: every number of the method specification, invariances, oracles,
// coverage of the stated intervals (1000 axes with RONDURE_FULL=1), hard and bad input.
#include "fit/rotary/axes.h"

#include <algorithm>
#include <complex>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "fit/rotary/ball_setup.h"
#include "fit/rotary/internal/published_axes.h"
#include "tests/fit/oracles/dial.h"
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
using test::example_balls;
using test::example_errors;
using test::hanging;
using test::kUm;
using test::kUrad;
using test::measured;
using ::testing::HasSubstr;

constexpr double kDeg45 = 45.0 * kDegree;
const RotaryAxis kC = {Vector3d::UnitZ(), Vector3d::Zero()};
const RotaryAxis kA = {Vector3d::UnitX(), Vector3d::Zero()};

std::vector<Vector3d> turned(const std::vector<Vector3d>& p, const RotaryAxis& axis, double angle) {
  std::vector<Vector3d> out;
  for (const Vector3d& one : p) out.emplace_back(axis.turn(angle) * one);
  return out;
}

std::vector<std::string> letters(std::size_t n) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < n; ++i) out.emplace_back(1, static_cast<char>('a' + i));
  return out;
}

Vector6 no_errors(double /*angle*/) { return Vector6::Zero(); }

RotaryMeasurement example(const test::Probing& probing) {
  return measured(kC, example_balls(), circle_of(24), example_errors, probing);
}

const RotaryStation& station_at(const RotaryStudy& study, double deg) {
  return *std::find_if(study.stations.begin(), study.stations.end(),
                       [&](const auto& s) { return std::abs(s.angle_rad - deg * kDegree) < 1e-9; });
}

// ---- Section 2: model and published matrices.

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
    EXPECT_EQ(PublishedMatrix(published_c_matrix(s, angle)).fullPivLu().rank(), 6);
    EXPECT_EQ(PublishedMatrix(published_a_matrix(s, angle)).fullPivLu().rank(), 6);
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
      return Vector6(m.colPivHouseholderQr().solve(dp) - x);
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
      const Vector6 x = m.colPivHouseholderQr().solve(dp);
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

/// Covariance diagonal of a sphere centre from points of unit deviation, radius fitted or held.
Vector3d centre_uncertainty(const std::vector<Vector3d>& normals, bool hold_radius) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const Vector3d& n : normals) {
    const Eigen::Vector4d row(n.x(), n.y(), n.z(), 1.0);
    sum += row * row.transpose();
  }
  if (hold_radius) return sum.topLeftCorner<3, 3>().inverse().diagonal().cwiseSqrt();
  return sum.inverse().diagonal().head<3>().cwiseSqrt();
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
  const Vector3d whole = centre_uncertainty(spiral(400, -1.0), false);
  EXPECT_LT((whole - Vector3d::Constant(std::sqrt(3.0 / 400.0))).norm(), 0.002);
  // 25 points of a hemisphere; how they are spread moves the second digit.
  const Vector3d fitted = centre_uncertainty(spiral(25, 0.0), false);
  EXPECT_LT((fitted - Vector3d(0.34, 0.35, 0.69)).cwiseAbs().maxCoeff(), 0.02);
  const Vector3d held = centre_uncertainty(spiral(25, 0.0), true);
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

std::vector<Vector3d> five_balls() {
  return {{60, 10, 40}, {-55, 30, 100}, {-20, -65, 20}, {35, -40, 110}, {20, 65, 70}};
}

Vector6 fixture_errors(double phi) {
  Vector6 out;
  out << test::wave(phi, 3, 2, 0.4), test::wave(phi, 20, 1, 0.2),
      test::wave(phi, 15, 1, 1.0) + test::wave(phi, 2, 3, 0.1), test::wave(phi, 10, 1, 0.3),
      test::wave(phi, 90, 1, 0.5), test::wave(phi, 70, 1, -0.4);
  out.head<3>() *= kUm;
  out.tail<3>() *= kUrad;
  return out;
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
  const Eigen::MatrixXd weight = covariance.inverse();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int pass = 0; pass < 30; ++pass) {
    std::vector<Vector3d> here;
    Eigen::VectorXd dp(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      here.emplace_back(motion * p[static_cast<std::size_t>(i)]);
      dp.segment<3>(3 * i) = pose.balls[static_cast<std::size_t>(i)].centre_mm - here.back();
    }
    const Eigen::MatrixXd a = error_matrix(here);
    const Vector6 x = (a.transpose() * weight * a).fullPivLu().solve(a.transpose() * weight * dp);
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

// ---- Section 6: place of the axis.

TEST(AxisOffset, FactorsOfArcsAreThoseOfTheSpecification) {
  for (const auto& [arc, factor] :
       std::vector<std::pair<double, double>>{{180, 1.30}, {90, 2.30}, {60, 3.37}}) {
    RotaryTable table;
    table.axis = kC;
    for (const double angle : angles_deg(0, arc, 2001)) table.rows.push_back({.angle_rad = angle});
    for (RotaryTableRow& row : table.rows) row.covariance = Matrix6::Identity();
    const auto offset = axis_offset(table);
    ASSERT_TRUE(offset);
    EXPECT_NEAR(offset->arc_factor, factor, 0.0051);
    EXPECT_NEAR(offset->d_u_mm.x() * std::sqrt(2001.0), factor, 0.0051);
    EXPECT_EQ(offset->d_u_mm.z(), 0.0);
  }
  RotaryTable circle;
  circle.axis = kC;
  circle.full_circle = true;
  for (const double angle : circle_of(24)) circle.rows.push_back({.angle_rad = angle});
  EXPECT_NEAR(axis_offset(circle)->arc_factor, 1.00, 1e-12);
}

TEST(AxisOffset, SeparatesThePlaceOfTheAxisFromItsMotion) {
  const auto study = identify_rotary_axis(example({.noisy = false, .references = 0}));
  ASSERT_TRUE(study);
  ASSERT_TRUE(study->offset);
  EXPECT_LT((study->offset->d_mm / kUm - Vector3d(12.00, -20.00, 0.0)).norm(), 0.005);
  EXPECT_LT((study->offset->e_rad / kUrad - Vector3d(60.0, -35.0, 0.0)).norm(), 0.005);
  EXPECT_NEAR(study->offset->c_mm.x() / kUm, -1.43, 0.0051);
  // Forcing c = 0 moves d by c / 2: least squares of tau = (1 - z) d on a full circle.
  std::complex<double> sum = 0.0;
  double squares = 0.0;
  for (const RotaryTableRow& row : study->table.rows) {
    const auto z = 1.0 - std::polar(1.0, row.angle_rad);
    sum += std::conj(z) * std::complex<double>(row.errors(0), row.errors(1));
    squares += std::norm(z);
  }
  EXPECT_NEAR(std::abs(sum / squares - std::complex<double>(12.0 * kUm, -20.0 * kUm)) / kUm, 0.72,
              0.0051);
  // The line: a point of it is displaced by d, its direction by e x a.
  EXPECT_LT((study->offset->axis.origin_mm - study->offset->d_mm).norm(), 1e-15);
  EXPECT_NEAR(study->offset->axis.direction.x() / kUrad, -35.0, 0.01);
  EXPECT_NEAR(study->offset->axis.direction.y() / kUrad, -60.0, 0.01);
}

TEST(AxisOffset, ARealDisplacedAndTiltedAxisIsFoundForAnyDirection) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {2});
    const RotaryAxis axis = {draw(random, 1.0).normalized(), draw(random, 200.0)};
    const Vector3d a = axis.direction;
    const auto across_axis = [&](const Vector3d& v) { return Vector3d(v - v.dot(a) * a); };
    const Vector3d d = across_axis(draw(random, 0.02));
    const Vector3d e = across_axis(draw(random, 1e-4));
    // The true line is turned about; the errors are what that differs from the nominal rotation.
    const RotaryAxis real = {(a + e.cross(a)).normalized(), axis.origin_mm + d};
    auto m = measured(axis, five_balls(), circle_of(12), no_errors, {.noisy = false});
    for (RotaryPose& pose : m.stations) {
      for (std::size_t i = 0; i < pose.balls.size(); ++i) {
        const Vector3d from_line = axis.origin_mm + five_balls()[i] - real.origin_mm;
        pose.balls[i].centre_mm = real.origin_mm + real.turn(pose.angle_rad) * from_line;
      }
    }
    const auto study = identify_rotary_axis(m);
    ASSERT_TRUE(study) << study.error().what;
    EXPECT_LT((study->offset->d_mm - d).norm(), 2e-5);  // second order: 20 um x 100 urad x lever
    EXPECT_LT((study->offset->e_rad - e).norm(), 2e-8);
    for (const RotaryStation& station : study->stations) {
      const Vector3d& offset = study->offset->d_mm;
      const Vector3d shift = offset - axis.turn(station.angle_rad) * offset;
      const Vector3d left = station.errors.values().head<3>() - shift;
      EXPECT_LT(left.norm(), 2.0 * e.norm() * d.norm());  // second order
    }
  }
}

TEST(AxisOffset, IsRefusedBelow45DegreesButTheErrorsStand) {
  const auto m = measured(kA, five_balls(), angles_deg(-20, 20, 9), fixture_errors, {});
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  EXPECT_FALSE(study->offset);
  EXPECT_EQ(axis_offset(study->table).error().code, Code::kShortArc);
  EXPECT_TRUE(RotaryModel::of(study->table));
  EXPECT_TRUE(std::any_of(study->warnings.begin(), study->warnings.end(),
                          [](const auto& w) { return w.code == Code::kShortArc; }));
}

// ---- Section 7: between the stations.

/// Largest error between stations of a unit wave with k undulations a turn, over its phase [%].
double interpolation_error(int k, const std::vector<double>& stations, bool circle) {
  double out = 0.0;
  for (int phase = 0; phase < 48; ++phase) {
    RotaryTable table;
    table.axis = kC;
    table.full_circle = circle;
    const auto value = [&](double x) { return std::cos(k * x - phase * core::kTwoPi / 48.0); };
    for (const double angle : stations)
      table.rows.push_back({.angle_rad = angle, .errors = Vector6::Constant(value(angle))});
    const auto model = RotaryModel::of(table);
    const double last = circle ? core::kTwoPi : stations.back();
    for (int i = 0; i <= 400; ++i) {
      const double x = stations.front() + (last - stations.front()) * i / 400.0;
      out = std::max(out, std::abs(model->at(x)->w_rad.z() - value(x)));
    }
  }
  return 100.0 * out;
}

/// The same of a natural spline, solved densely: what is not used here, and why.
double natural_error(int k, const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const double h = x[1] - x[0];
  double out = 0.0;
  for (int phase = 0; phase < 48; ++phase) {
    const auto value = [&](double at) { return std::cos(k * at - phase * core::kTwoPi / 48.0); };
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      m.block<1, 3>(i, i - 1) << h / 6.0, 2.0 * h / 3.0, h / 6.0;
      const double at = x[static_cast<std::size_t>(i)];
      right(i) = (value(at + h) - 2.0 * value(at) + value(at - h)) / h;
    }
    const Eigen::VectorXd second = m.partialPivLu().solve(right);
    for (int i = 0; i < 400; ++i) {
      const double b = i * static_cast<double>(n - 1) / 400.0;
      const auto j = static_cast<Eigen::Index>(b);
      const double v = b - static_cast<double>(j);
      const double u = 1.0 - v;
      const double left = x[static_cast<std::size_t>(j)];
      const double spline =
          u * value(left) + v * value(left + h) +
          ((u * u * u - u) * second(j) + (v * v * v - v) * second(j + 1)) * h * h / 6.0;
      out = std::max(out, std::abs(spline - value(left + v * h)));
    }
  }
  return 100.0 * out;
}

TEST(RotaryModel, InterpolatesAsWellAsTheSpecificationSays) {
  const auto circle = circle_of(24);
  EXPECT_NEAR(interpolation_error(1, circle, true), 0.001, 0.0005);
  EXPECT_NEAR(interpolation_error(2, circle, true), 0.02, 0.005);
  EXPECT_NEAR(interpolation_error(3, circle, true), 0.11, 0.01);
  const auto arc = angles_deg(-90, 90, 13);
  EXPECT_NEAR(interpolation_error(1, arc, false), 0.013, 0.001);
  EXPECT_NEAR(interpolation_error(2, arc, false), 0.21, 0.01);
  EXPECT_NEAR(interpolation_error(3, arc, false), 1.1, 0.05);
  EXPECT_NEAR(natural_error(1, arc), 0.34, 0.02);
  EXPECT_NEAR(natural_error(2, arc), 1.4, 0.05);
  EXPECT_NEAR(natural_error(3, arc), 3.3, 0.15);
}

TEST(RotaryModel, PassesThroughTheStationsAndRefusesToExtrapolate) {
  const auto m = measured(kA, five_balls(), angles_deg(-90, 90, 13), fixture_errors, {.seed = 2});
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  const auto model = RotaryModel::of(study->table);
  ASSERT_TRUE(model);
  for (const RotaryStation& station : study->stations) {
    const auto at = model->at(station.angle_rad);
    ASSERT_TRUE(at);
    EXPECT_LT((at->values() - station.errors.values()).norm(), 1e-15);
    EXPECT_LT((at->sigma() - station.errors.sigma()).cwiseQuotient(at->sigma()).norm(), 1e-6);
  }
  EXPECT_EQ(model->at(90.1 * kDegree).error().code, Code::kOutOfRange);
  EXPECT_EQ(model->at(-90.1 * kDegree).error().code, Code::kOutOfRange);
  EXPECT_THAT(model->at(95.0 * kDegree).error().what, HasSubstr("-90..90 deg"));
  EXPECT_FALSE(model->at(std::nan("")));
  // Wider between the stations than at the middle of a long arc only by what the spline does.
  EXPECT_GT(model->at(83.0 * kDegree)->sigma()(0), 0.0);
}

TEST(RotaryModel, TakesAnyTurnOfAFullCircle) {
  const auto study = identify_rotary_axis(example({.seed = 3}));
  ASSERT_TRUE(study);
  EXPECT_TRUE(study->table.full_circle);
  const auto model = RotaryModel::of(study->table);
  for (const double deg : {0.0, 7.0, 200.0, 352.5, 359.9}) {
    const Vector6 here = model->at(deg * kDegree)->values();
    EXPECT_LT((model->at((deg + 360.0) * kDegree)->values() - here).norm(), 1e-15);
    EXPECT_LT((model->at((deg - 720.0) * kDegree)->values() - here).norm(), 1e-15);
  }
}

TEST(RotaryModel, FourierAndPolynomialFitTheirOwnCurves) {
  auto m = example({.noisy = false, .references = 0});
  auto study = identify_rotary_axis(m, {.curve = RotaryCurve::kFourier});
  ASSERT_TRUE(study);
  auto model = RotaryModel::of(study->table);
  ASSERT_TRUE(model);
  const auto arc = measured(kA, five_balls(), angles_deg(-90, 90, 13),
                            [](double phi) {
                              Vector6 out = fixture_errors(phi);
                              out(0) = 4.0 * kUm * phi * phi * phi;
                              out(2) = test::wave(phi, 15, 1, 1.0) * kUm;
                              return out;
                            },
                            {.noisy = false, .references = 0});
  const auto arc_study = identify_rotary_axis(arc, {.curve = RotaryCurve::kPolynomial});
  ASSERT_TRUE(arc_study);
  const auto arc_model = RotaryModel::of(arc_study->table);
  ASSERT_TRUE(arc_model);
  for (double deg = -88.0; deg < 90.0; deg += 7.0) {
    const double phi = deg * kDegree;
    EXPECT_LT((model->at(phi)->values() - example_errors(phi)).norm(), 1e-10);
    EXPECT_NEAR(arc_model->at(phi)->t_mm.x(), 4.0 * kUm * phi * phi * phi, 1e-10);
    EXPECT_NEAR(arc_model->at(phi)->t_mm.z(), test::wave(phi, 15, 1, 1.0) * kUm, 1e-10);
    // Least squares of 24 stations by 17 coefficients is never wider than a single station.
    EXPECT_LT(model->at(phi)->sigma()(2), 1.05 * study->stations[0].errors.sigma()(2));
  }
  RotaryTable table = study->table;
  table.curve = RotaryCurve::kPolynomial;
  EXPECT_EQ(RotaryModel::of(table).error().code, Code::kBadOption);
  table = arc_study->table;
  table.curve = RotaryCurve::kFourier;
  EXPECT_EQ(RotaryModel::of(table).error().code, Code::kBadOption);
  table.curve = RotaryCurve::kSpline;
  table.rows.resize(3);
  EXPECT_EQ(RotaryModel::of(table).error().code, Code::kTooFewPoints);
  table = arc_study->table;
  std::swap(table.rows[3], table.rows[4]);
  EXPECT_EQ(RotaryModel::of(table).error().code, Code::kTable);
  table = arc_study->table;
  table.rows[3].errors(2) = std::nan("");
  EXPECT_EQ(RotaryModel::of(table).error().code, Code::kNotFinite);
}

TEST(RotaryModel, MotionTakesPointsWhereTheyAre) {
  const RotaryAxis axis = {Vector3d(1, 2, 2) / 3.0, {100, -50, 20}};
  const auto m = measured(axis, five_balls(), angles_deg(-90, 90, 13), fixture_errors,
                          {.noisy = false, .references = 0});
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study) << study.error().what;
  const auto model = RotaryModel::of(study->table);
  for (const RotaryPose& pose : m.stations) {
    const auto motion = model->motion(pose.angle_rad);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_LT((*motion * m.references[0][i].centre_mm - pose.balls[i].centre_mm).norm(), 1e-10);
    }
  }
}

TEST(RotaryAxes, HysteresisGoesIntoTheUncertaintyAndNotIntoTheTable) {
  const double h = 2.0 * kUm;
  const auto both = [&](double sense) {
    return [sense, h](double phi) {
      Vector6 out = fixture_errors(phi);
      out(1) += sense * h;
      return out;
    };
  };
  auto m = measured(kA, five_balls(), angles_deg(-90, 90, 13), both(1.0), {.seed = 8});
  auto back = measured(kA, five_balls(), angles_deg(-90, 90, 13), both(-1.0), {.seed = 9});
  for (RotaryPose& pose : m.stations) pose.approach = Approach::kForward;
  std::reverse(back.stations.begin(), back.stations.end());
  for (RotaryPose& pose : back.stations) {
    pose.approach = Approach::kBackward;
    // The same body: its reference is that of m, up to the noise of both.
    m.stations.push_back(pose);
  }
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study) << study.error().what;
  ASSERT_EQ(study->table.rows.size(), 13U);
  EXPECT_NEAR(study->table.hysteresis_rms(1), h, 0.3 * kUm);
  EXPECT_LT(study->table.hysteresis_rms(0), 0.4 * kUm);
  const auto model = RotaryModel::of(study->table);
  for (const RotaryTableRow& row : study->table.rows) {
    EXPECT_TRUE(row.both_directions);
    EXPECT_NEAR(row.hysteresis(1), h, 2.0 * kUm);
    EXPECT_NEAR(row.errors(1), fixture_errors(row.angle_rad)(1), 2.5 * kUm);
    EXPECT_GT(model->at(row.angle_rad)->sigma()(1), 0.85 * h);
  }
}

TEST(RotaryAxes, ComparesZeroAnd360Degrees) {
  const auto stations = angles_deg(0, 360, 25);
  auto m = measured(kC, five_balls(), stations, example_errors, {.seed = 6});
  const auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study) << study.error().what;
  EXPECT_TRUE(study->periodicity_checked);
  EXPECT_EQ(study->table.rows.size(), 24U);
  EXPECT_FALSE(identify_rotary_axis(example({}))->periodicity_checked);
  for (BallCentre& ball : m.stations.back().balls) ball.centre_mm.z() += 4.0 * kUm;
  const auto drifted = identify_rotary_axis(m);
  ASSERT_FALSE(drifted);
  EXPECT_EQ(drifted.error().code, Code::kInconsistent);
  EXPECT_THAT(drifted.error().what, HasSubstr("0 and 360 deg are one place, but error EZ"));
}

// ---- Section 10: the worked example.

TEST(RotaryAxes, WorkedExampleWithoutNoise) {
  const Vector6 x = example_errors(kDeg45);
  Vector6 printed;
  printed << -11.61714, -13.50248, 0.46303, -11.08, -58.20, 4.27;
  EXPECT_LT((x.head<3>() / kUm - printed.head<3>()).cwiseAbs().maxCoeff(), 5.1e-6);
  EXPECT_LT((x.tail<3>() / kUrad - printed.tail<3>()).cwiseAbs().maxCoeff(), 5.1e-3);
  const auto m = example({.noisy = false, .references = 0});
  const std::array<Vector3d, 3> deviations = {{{-3.03714, -15.31559, -1.98637},
                                               {-3.33858, -15.61720, -6.88570},
                                               {2.78334, -16.42379, -1.98620}}};
  const auto& balls = m.stations[3].balls;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d dp = balls[i].centre_mm - kC.turn(kDeg45) * example_balls()[i];
    EXPECT_LT((dp / kUm - deviations[i]).cwiseAbs().maxCoeff(), 5.1e-6) << i;
  }
  const auto exact = identify_rotary_axis(m);
  ASSERT_TRUE(exact);
  EXPECT_LT((station_at(*exact, 45.0).errors.values() - x).norm(), 1e-11);
  for (const auto solver : {RotaryOptions::Solver::kLinear, RotaryOptions::Solver::kAsPublished}) {
    const auto linear = identify_rotary_axis(m, {.solver = solver});
    ASSERT_TRUE(linear) << linear.error().what;
    double t = 0.0;
    double w = 0.0;
    for (const RotaryStation& station : linear->stations) {
      const Vector6 left = station.errors.values() - example_errors(station.angle_rad);
      t = std::max(t, left.head<3>().cwiseAbs().maxCoeff() / kUm);
      w = std::max(w, left.tail<3>().cwiseAbs().maxCoeff() / kUrad);
    }
    EXPECT_NEAR(t, 0.0017, 0.0003);
    EXPECT_NEAR(w, 0.005, 0.0015);
  }
}

TEST(RotaryAxes, WorkedExampleWithNoise) {
  const int runs = test::full() ? 400 : 60;
  Vector6 squares = Vector6::Zero();
  Vector6 squares_at_0 = Vector6::Zero();
  double s0 = 0.0;
  Eigen::Vector2d worst = Eigen::Vector2d::Zero();  // of d, in its uncertainty
  for (int run = 0; run < runs; ++run) {
    const auto study = identify_rotary_axis(
        example({.seed = static_cast<std::uint64_t>(run + 1), .references = 0}));
    ASSERT_TRUE(study) << study.error().what;
    for (const RotaryStation& station : study->stations) {
      const Vector6 left = station.errors.values() - example_errors(station.angle_rad);
      squares += left.cwiseAbs2() / (24.0 * runs);
    }
    const RotaryStation& first = study->stations.front();
    squares_at_0 += first.errors.values().cwiseAbs2() / runs;
    s0 += study->s0 * 0.5 / runs;
    EXPECT_EQ(study->dof, 72);
    const Vector3d d = study->offset->d_mm - Vector3d(12.0, -20.0, 0.0) * kUm;
    worst = worst.cwiseMax(d.cwiseAbs().head<2>().cwiseQuotient(study->offset->d_u_mm.head<2>()));
    if (run == 0) {
      const Vector6 u = first.errors.sigma() / std::max(1.0, study->s0);
      const std::array<double, 6> predicted = {1.70, 0.84, 0.46, 4.33, 7.07, 7.07};
      for (int k = 0; k < 6; ++k) {
        EXPECT_NEAR(u(k) / (k < 3 ? kUm : kUrad), predicted[static_cast<std::size_t>(k)], 0.0061);
      }
      EXPECT_LT((d / kUm - Vector3d(-0.55, -0.11, 0.0)).norm(), 1.5);  // "one noisy run"
    }
  }
  const double share = test::full() ? 0.015 : 0.04;
  const std::array<double, 6> std_all = {1.34, 1.33, 0.46, 5.85, 5.87, 7.04};
  for (int k = 0; k < 6; ++k) {
    const double expected = std_all[static_cast<std::size_t>(k)];
    const double unit = k < 3 ? kUm : kUrad;
    EXPECT_NEAR(std::sqrt(squares(k)) / unit, expected, share * expected + 0.005) << k;
  }
  EXPECT_NEAR(s0, 0.5, 0.01);
  EXPECT_LT(worst.maxCoeff(), 4.5);
}

TEST(RotaryAxes, WorkedExampleOfTheAAxis) {
  const auto balls = hanging({{150, 50}, {150, 150}, {250, 150}});
  const auto angles = angles_deg(0, 90, 10);
  // Over a quarter arc the sum is found however weak the split is; as published the same.
  const auto truth = [](double phi) {
    Vector6 out = example_errors(phi);
    return Vector6(out * 0.5);
  };
  const auto m = measured(kA, balls, angles, truth, {.noisy = false, .references = 0});
  for (const auto solver : {RotaryOptions::Solver::kExact, RotaryOptions::Solver::kAsPublished}) {
    const auto study = identify_rotary_axis(m, {.solver = solver});
    ASSERT_TRUE(study) << study.error().what;
    EXPECT_FALSE(study->table.full_circle);
    const double limit = solver == RotaryOptions::Solver::kExact ? 1e-10 : 2e-6;
    for (const RotaryStation& station : study->stations)
      EXPECT_LT((station.errors.values() - truth(station.angle_rad)).norm(), limit);
    EXPECT_NEAR(study->offset->arc_factor, 2.30, 0.25);  // 10 stations and not an arc's integral
  }
}

// ---- Invariances.

TEST(RotaryAxes, DoesNotDependOnFrameOrderOrUnit) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {12});
    const auto m = measured({Vector3d::UnitX(), {30, -20, 500}}, five_balls(),
                            angles_deg(-90, 90, 7), fixture_errors, {.seed = seed});
    const auto study = identify_rotary_axis(m);
    ASSERT_TRUE(study) << study.error().what;

    Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
    move.translate(draw(random, 400.0));
    move.rotate(Eigen::AngleAxisd(3.0 * random.uniform(), draw(random, 1.0).normalized()));
    const auto with_each = [&](const auto& change) {
      RotaryMeasurement out = m;
      for (auto& reference : out.references)
        for (BallCentre& ball : reference) change(ball);
      for (RotaryPose& pose : out.stations)
        for (BallCentre& ball : pose.balls) change(ball);
      return out;
    };
    auto moved = with_each([&](BallCentre& ball) { ball.centre_mm = move * ball.centre_mm; });
    moved.axis.origin_mm = move * m.axis.origin_mm;
    moved.axis.direction = move.linear() * m.axis.direction;
    auto scaled = with_each([](BallCentre& ball) {
      ball.centre_mm *= 3.0;
      ball.u_mm *= 3.0;
    });
    scaled.axis.origin_mm *= 3.0;
    auto shuffled = m;
    for (RotaryPose& pose : shuffled.stations) std::reverse(pose.balls.begin(), pose.balls.end());
    std::swap(shuffled.references[0][1], shuffled.references[0][3]);
    auto elsewhere = m;  // another origin of the same nominal line: translations along with it
    elsewhere.axis.origin_mm += Vector3d(40.0, 0.0, 0.0);

    const auto a = identify_rotary_axis(moved);
    const auto b = identify_rotary_axis(scaled);
    const auto c = identify_rotary_axis(shuffled);
    const auto d = identify_rotary_axis(elsewhere);
    ASSERT_TRUE(a && b && c && d);
    for (std::size_t k = 0; k < m.stations.size(); ++k) {
      const RotaryErrors& here = study->stations[k].errors;
      const Matrix3d r = move.linear();
      EXPECT_LT((a->stations[k].errors.t_mm - r * here.t_mm).norm(), 1e-10);
      EXPECT_LT((a->stations[k].errors.w_rad - r * here.w_rad).norm(), 1e-12);
      EXPECT_NEAR(a->stations[k].chi2, study->stations[k].chi2, 1e-5);
      EXPECT_LT((b->stations[k].errors.t_mm - 3.0 * here.t_mm).norm(), 1e-10);
      EXPECT_LT((b->stations[k].errors.w_rad - here.w_rad).norm(), 1e-12);
      EXPECT_LT((c->stations[k].errors.values() - here.values()).norm(), 1e-11);
      EXPECT_LT((d->stations[k].errors.w_rad - here.w_rad).norm(), 1e-12);
      const Vector3d s(40.0, 0.0, 0.0);
      const Vector3d shifted =
          error_motion(here.t_mm, here.w_rad) * (kA.turn(m.stations[k].angle_rad) * s) - s;
      EXPECT_LT((d->stations[k].errors.t_mm - shifted).norm(), 1e-10);
      const Matrix3d cov = point_covariance_mm2(here.covariance, s);
      EXPECT_LT((cov - d->stations[k].errors.covariance.topLeftCorner<3, 3>()).norm(),
                1e-6 * cov.norm());
    }
    EXPECT_NEAR(c->s0, study->s0, 1e-6);
  }
}

TEST(RotaryAxes, CountsAnglesFromTheReferencePose) {
  auto m = measured(kC, five_balls(), angles_deg(-90, 90, 13), fixture_errors, {.seed = 1});
  const auto study = identify_rotary_axis(m);
  m.reference_rad = 0.5;
  for (RotaryPose& pose : m.stations) pose.angle_rad += 0.5;
  const auto later = identify_rotary_axis(m);
  ASSERT_TRUE(study && later);
  EXPECT_LT((study->offset->d_mm - later->offset->d_mm).norm(), 1e-12);
  const auto model = RotaryModel::of(later->table);
  EXPECT_LT((model->at(0.7)->values() - RotaryModel::of(study->table)->at(0.2)->values()).norm(),
            1e-14);
}

// ---- Figure: the stated intervals hold what they say.

/// Shares of 95 % intervals that hold the true error.
struct Coverage {
  double inside = 0.0;
  double all = 0.0;
  [[nodiscard]] double share() const { return 100.0 * inside / all; }
  void count(double error, double u) {
    all += 1.0;
    inside += std::abs(error) <= 1.959964 * u ? 1.0 : 0.0;
  }
};

/// An axis of the classes of section 8: offsets 25 um, tilts 120 urad, motion 3 um and 15 urad.
struct RandomAxis {
  RotaryAxis axis;
  std::vector<Vector3d> balls;
  Vector3d d;
  Vector3d e;
  Eigen::Matrix<double, 6, 4> wave;  ///< Amplitude and phase at 2 and at 3 undulations.

  explicit RandomAxis(std::uint64_t seed) {
    core::KeyedNoise random(seed, {21});
    axis.direction = Vector3d::Unit(static_cast<Eigen::Index>(seed % 3));
    axis.origin_mm = draw(random, 100.0);
    for (int i = 0; i < 5; ++i) {
      const Vector3d p = draw(random, 70.0);
      balls.emplace_back(p.x(), p.y(), p.z() * 110.0 / 70.0);
    }
    const Vector3d a = axis.direction;
    d = draw(random, 25.0 * kUm);
    e = draw(random, 120.0 * kUrad);
    d -= d.dot(a) * a;
    e -= e.dot(a) * a;
    for (int k = 0; k < 6; ++k) {
      const double size = k < 3 ? 3.0 * kUm : 15.0 * kUrad;
      wave.row(k) << size * random.uniform(), 6.0 * random.uniform(), 0.5 * size * random.uniform(),
          6.0 * random.uniform();
    }
  }
  [[nodiscard]] Vector6 errors(double phi) const {
    const Matrix3d turn = axis.turn(phi);
    Vector6 out;
    out << d - turn * d, e - turn * e;
    for (int k = 0; k < 6; ++k) {
      out(k) += test::wave(phi, wave(k, 0), 2, wave(k, 1));
      out(k) += test::wave(phi, wave(k, 2), 3, wave(k, 3));
    }
    return out;
  }
};

TEST(RotaryAxes, StatedIntervalsHoldTheTrueErrorsOfSimulatedAxes) {
  const std::uint64_t axes = test::full() ? 1000 : 60;
  Coverage stations;
  Coverage between;
  Coverage place;
  for (std::uint64_t seed = 0; seed < axes; ++seed) {
    SCOPED_TRACE(seed);
    const RandomAxis truth(seed);
    const auto of = [&](double phi) { return truth.errors(phi); };
    const bool circle = seed % 3 == 2;
    const auto angles = circle ? circle_of(24) : angles_deg(-90, 90, 13);
    const auto study =
        identify_rotary_axis(measured(truth.axis, truth.balls, angles, of, {.seed = seed}));
    ASSERT_TRUE(study) << study.error().what;
    for (const RotaryStation& station : study->stations) {
      const Vector6 left = station.errors.values() - of(station.angle_rad);
      for (int k = 0; k < 6; ++k) stations.count(left(k), station.errors.sigma()(k));
    }
    const auto model = RotaryModel::of(study->table);
    for (std::size_t i = 1; i < angles.size(); ++i) {
      const double phi = 0.5 * (angles[i - 1] + angles[i]);
      const auto at = model->at(phi);
      for (int k = 0; k < 6; ++k) between.count(at->values()(k) - of(phi)(k), at->sigma()(k));
    }
    if (!circle) continue;  // on an arc slow motion errors go into the offset
    for (int k = 0; k < 2; ++k) {
      place.count(study->offset->d_mm(k) - truth.d(k), study->offset->d_u_mm(k));
      place.count(study->offset->e_rad(k) - truth.e(k), study->offset->e_u_rad(k));
    }
  }
  const double slack = test::full() ? 0.0 : 1.5;
  for (const Coverage* one : {&stations, &between}) {
    EXPECT_GE(one->share(), 93.0 - slack);
    EXPECT_LE(one->share(), 97.0 + slack);
  }
  EXPECT_GE(place.share(), test::full() ? 93.0 : 86.0);
  EXPECT_LE(place.share(), test::full() ? 97.0 : 100.0);
  std::printf(
      "%llu axes: inside 95 %% intervals: stations %.2f %%, between them %.2f %%, place of "
      "the axis (full circles) %.2f %%\n",
      static_cast<unsigned long long>(axes), stations.share(), between.share(), place.share());
}

// ---- Bad input.

RotaryMeasurement good() {
  return measured(kA, five_balls(), angles_deg(-90, 90, 13), fixture_errors, {.seed = 1});
}

core::Error refusal(const RotaryMeasurement& m) {
  const auto study = identify_rotary_axis(m);
  EXPECT_FALSE(study);
  return study ? core::Error{} : study.error();
}

TEST(RotaryAxes, RefusesBadInputWithTheReason) {
  ASSERT_TRUE(identify_rotary_axis(good()));
  const auto after = [](const auto& change) {
    auto m = good();
    change(m);
    return refusal(m);
  };
  EXPECT_EQ(after([](auto& m) { m.axis.direction *= 2.0; }).code, Code::kBadOption);
  EXPECT_EQ(after([](auto& m) { m.axis.origin_mm.x() = std::nan(""); }).code, Code::kNotFinite);
  EXPECT_EQ(after([](auto& m) { m.references.clear(); }).code, Code::kMissingKey);
  EXPECT_EQ(after([](auto& m) { m.stations.clear(); }).code, Code::kTooFewPoints);
  EXPECT_EQ(after([](auto& m) { m.stations[3] = m.stations[2]; }).code, Code::kRepeatedKey);
  EXPECT_EQ(after([](auto& m) { m.stations[3].balls[1].ball = "z"; }).code, Code::kUnknownKey);
  EXPECT_EQ(after([](auto& m) { m.stations[3].balls[1].ball = "a"; }).code, Code::kRepeatedKey);
  EXPECT_EQ(after([](auto& m) { m.stations[3].balls[1].u_mm.y() = 0.0; }).code, Code::kBadOption);
  EXPECT_EQ(after([](auto& m) { m.stations[3].balls[1].centre_mm.y() = std::nan(""); }).code,
            Code::kNotFinite);
  EXPECT_EQ(after([](auto& m) { m.stations[3].angle_rad = std::nan(""); }).code, Code::kNotFinite);
  EXPECT_EQ(after([](auto& m) { m.highest_rad = 1.0; }).code, Code::kPoseRange);
  const auto few = after([](auto& m) {
    for (auto& reference : m.references) reference.resize(2);
    for (auto& pose : m.stations) pose.balls.resize(2);
  });
  EXPECT_EQ(few.code, Code::kTooFewPoints);
  EXPECT_THAT(few.what, HasSubstr("add a ball off the line through a and b"));
  EXPECT_EQ(after([](auto& m) {
              for (auto& pose : m.stations) pose.balls.resize(2);
            }).code,
            Code::kRank);
  EXPECT_EQ(identify_rotary_axis(good(), {.outlier_probability = 1.0}).error().code,
            Code::kBadOption);
}

TEST(RotaryAxes, NamesMixedUnitsAndConfusedBalls) {
  auto m = good();
  for (BallCentre& ball : m.stations[5].balls) ball.centre_mm /= 25.4;
  EXPECT_EQ(refusal(m).code, Code::kUnits);
  EXPECT_THAT(refusal(m).what, HasSubstr("mm and inch are mixed"));
  m = good();
  for (BallCentre& ball : m.stations[5].balls) ball.centre_mm *= 1000.0;
  EXPECT_THAT(refusal(m).what, HasSubstr("mm and um or m are mixed"));
  m = good();
  std::swap(m.stations[5].balls[0].ball, m.stations[5].balls[1].ball);
  EXPECT_THAT(refusal(m).what, HasSubstr("balls are confused"));
}

TEST(RotaryAxes, SaysWhenTheAnglesHaveTheWrongSenseOrUnit) {
  auto m = good();
  for (RotaryPose& pose : m.stations) pose.angle_rad *= -1.0;
  EXPECT_EQ(refusal(m).code, Code::kSense);
  EXPECT_THAT(refusal(m).what, HasSubstr("opposite sense leave 0.000"));
  m = good();
  for (RotaryPose& pose : m.stations) pose.angle_rad /= kDegree;
  EXPECT_THAT(refusal(m).what, HasSubstr("degrees read for radians 0.000"));
  m = good();
  for (RotaryPose& pose : m.stations) pose.angle_rad *= kDegree;
  EXPECT_THAT(refusal(m).what, HasSubstr("radians read for degrees 0.000"));
}

TEST(RotaryAxes, NamesTheStationWhoseLabelIsWrong) {
  for (std::size_t station = 0; station < 13; ++station) {
    for (const double off_deg : {0.1, -1.0, 9.0}) {
      SCOPED_TRACE(::testing::Message() << station << ", " << off_deg << " deg");
      auto m = good();
      RotaryPose& wrong = m.stations[station];
      const double true_deg = wrong.angle_rad / kDegree;
      wrong.angle_rad += off_deg * kDegree;
      const auto refused = refusal(m);
      EXPECT_EQ(refused.code, Code::kInconsistent);
      EXPECT_THAT(refused.what, ::testing::StartsWith(fmt::format("station {:g} deg does not fit",
                                                                  wrong.angle_rad / kDegree)));
      const auto at = refused.what.find("a label of ");
      ASSERT_NE(at, std::string::npos) << refused.what;
      EXPECT_NEAR(std::stod(refused.what.substr(at + 11)), true_deg, 0.02);
      EXPECT_EQ(refused.what.find("station", 5), std::string::npos) << refused.what;
    }
  }
  auto m = good();  // too little to be told from a local error
  m.stations[4].angle_rad += 0.02 * kDegree;
  const auto doubted = identify_rotary_axis(m);
  ASSERT_TRUE(doubted) << doubted.error().what;
  ASSERT_EQ(doubted->warnings.size(), 1U);
  EXPECT_THAT(doubted->warnings[0].what, HasSubstr("station -29.98 deg does not fit"));
  EXPECT_TRUE(identify_rotary_axis(good())->warnings.empty());
  m = good();  // two of them
  m.stations[3].angle_rad += 1.0 * kDegree;
  m.stations[9].angle_rad -= 2.0 * kDegree;
  EXPECT_THAT(refusal(m).what, HasSubstr("station -44 deg"));
  EXPECT_THAT(refusal(m).what, HasSubstr("station 43 deg"));
  m = good();  // all of them: counted from another zero than the reference
  for (RotaryPose& pose : m.stations) pose.angle_rad += 1.0 * kDegree;
  EXPECT_THAT(refusal(m).what, HasSubstr("the reference pose (0 deg) does not fit"));
}

TEST(RotaryAxes, RecognisesSenseAndRadiansOverAFewDegrees) {
  const auto narrow = [](double factor) {
    auto m = measured(kA, five_balls(), angles_deg(-2, 2, 9), fixture_errors, {.seed = 1});
    for (RotaryPose& pose : m.stations) pose.angle_rad *= factor;
    return m;
  };
  ASSERT_TRUE(identify_rotary_axis(narrow(1.0)));
  EXPECT_EQ(refusal(narrow(kDegree)).code, Code::kSense);
  EXPECT_THAT(refusal(narrow(kDegree)).what, HasSubstr("in radians: give degrees"));
  EXPECT_EQ(refusal(narrow(-1.0)).code, Code::kSense);
  EXPECT_THAT(refusal(narrow(-1.0)).what, HasSubstr("turn the sign"));
}

TEST(RotaryAxes, RefusesBallsThatMoveOrGrow) {
  auto m = good();
  for (std::size_t k = 0; k < m.stations.size(); ++k) {  // 60 ppm by the end: 6 K of steel
    for (BallCentre& ball : m.stations[k].balls)
      ball.centre_mm *= 1.0 + 60e-6 * static_cast<double>(k) / 12.0;
  }
  EXPECT_EQ(refusal(m).code, Code::kInconsistent);
  EXPECT_THAT(refusal(m).what, HasSubstr("um"));
  m = good();
  for (RotaryPose& pose : m.stations) {
    const Vector3d along = pose.balls[1].centre_mm - pose.balls[2].centre_mm;
    pose.balls[1].centre_mm += 5.0 * kUm * along.normalized();
  }
  EXPECT_EQ(refusal(m).code, Code::kInconsistent);
}

TEST(RotaryAxes, PublishedMatricesAreRefusedForOtherBalls) {
  const RotaryOptions published = {.solver = RotaryOptions::Solver::kAsPublished};
  EXPECT_EQ(identify_rotary_axis(good(), published).error().code, Code::kBadOption);
  auto balls = example_balls();
  balls[1].x() = 20.0;
  const auto m = measured(kC, balls, circle_of(24), example_errors, {});
  const auto refused = identify_rotary_axis(m, published);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("(L1,H1), (L1,H2), (L2,H1)"));
  EXPECT_TRUE(identify_rotary_axis(m));
}

TEST(RotaryAxes, WarnsOfWeakSetupsAndOfADriftingReference) {
  auto m = example({.seed = 2});
  auto study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  const auto warned = [&](const char* text) {
    return std::any_of(study->warnings.begin(), study->warnings.end(),
                       [&](const auto& w) { return w.what.find(text) != std::string::npos; });
  };
  EXPECT_TRUE(warned("least redundancy"));
  EXPECT_FALSE(warned("drifts"));
  m = good();
  for (BallCentre& ball : m.references[2]) ball.centre_mm.x() += 8.0 * kUm;
  study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  EXPECT_TRUE(warned("the reference pose drifts by"));
  EXPECT_FALSE(warned("least redundancy"));
  m.references.resize(1);
  study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  EXPECT_TRUE(warned("measured 1 time"));
}

}  // namespace
}  // namespace rondure::fit
