// Rotary axes: the worked example of the method specification, invariances, coverage of the stated
// intervals (1000 axes with RONDURE_FULL=1), hard and bad input.
#include "fit/rotary/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/full.h"
#include "tests/fit/rotary_cases.h"
#include "tests/fit/spec_cases.h"
#include "tests/fit/specified_normals.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::angles_deg;
using test::circle_of;
using test::draw;
using test::example;
using test::example_balls;
using test::example_errors;
using test::five_balls;
using test::fixture_errors;
using test::hanging;
using test::kA;
using test::kC;
using test::kDeg45;
using test::kUm;
using test::kUrad;
using test::measured;
using test::station_at;
using ::testing::HasSubstr;

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

// ---- The worked cases, analyses_uncertainty 13.

/// four setups of a rectangle. Each is clamped with a tool length set wrong, and the axis
/// comes back to every station anew: errors that no ball shows.
RotaryMeasurement rectangle_with_all_influences() {
  constexpr double kNoise_mm = 0.5 * kUm;
  constexpr double kTool_mm = 0.3 * kUm;
  constexpr double kRepeat_rad = 1.0 * kUrad;
  const auto p0 = hanging({{150, 50}, {150, 150}, {250, 50}, {250, 150}});
  test::SpecifiedNormals normals(1);
  const auto three = [&] {
    const double x = normals.next();
    const double y = normals.next();
    return Vector3d(x, y, normals.next());
  };
  std::array<Vector3d, 4> references;
  std::array<Vector3d, 4> tools;
  for (Vector3d& one : references) one = kNoise_mm / std::sqrt(3.0) * three();
  for (Vector3d& one : tools) one = kTool_mm * three().cwiseProduct(Vector3d(0.0, 1.0, 1.0));
  for (int spare = 0; spare < 24; ++spare) static_cast<void>(normals.next());
  RotaryMeasurement out;
  out.axis = kC;
  const auto names = test::letters(4);
  out.references.emplace_back();
  for (std::size_t i = 0; i < 4; ++i) {
    out.references.back().push_back(
        {names[i], p0[i] + references[i], Vector3d::Constant(kNoise_mm / std::sqrt(3.0))});
  }
  for (const double angle : circle_of(24)) {
    RotaryPose& pose = out.stations.emplace_back();
    pose.angle_rad = angle;
    const Vector6 x = example_errors(angle);
    const Matrix3d turn = kC.turn(angle);
    for (std::size_t i = 0; i < 4; ++i) {
      const double repeat = kRepeat_rad * normals.next();
      const Vector3d noise = kNoise_mm * three();
      const Vector3d p = turn * p0[i];
      pose.balls.push_back({names[i],
                            error_motion(x.head<3>(), x.tail<3>()) * p +
                                (turn - Matrix3d::Identity()) * tools[i] +
                                repeat * Vector3d::UnitZ().cross(p) + noise,
                            Vector3d::Constant(kNoise_mm)});
    }
  }
  return out;
}

// Printed of the linear solution of exact data; the exact one is off by what that neglects.
TEST(RotaryAxes, TheRectangleOfFourSetupsReadsAsTheWorkedCase) {
  const RotaryMeasurement m = rectangle_with_all_influences();
  const auto linear = identify_rotary_axis(m, {.solver = RotaryOptions::Solver::kLinear});
  ASSERT_TRUE(linear) << linear.error().what;
  const auto whole = identify_rotary_axis(m);
  ASSERT_TRUE(whole) << whole.error().what;
  Vector6 printed;
  printed << -10.670, -12.924, 0.385, -10.173, -55.566, 8.951;
  Vector6 truth;
  truth << -11.617, -13.502, 0.463, -11.082, -58.205, 4.265;
  const Vector6 exact = example_errors(kDeg45);
  for (int k = 0; k < 6; ++k) {
    const double unit = k < 3 ? kUm : kUrad;
    EXPECT_NEAR(station_at(*linear, 45.0).errors.values()(k) / unit, printed(k), 5.1e-4) << k;
    EXPECT_NEAR(station_at(*whole, 45.0).errors.values()(k) / unit, printed(k),
                k < 3 ? 0.0017 : 0.005)
        << k;
    EXPECT_NEAR(exact(k) / unit, truth(k), 5.1e-4) << k;
  }
}

/// C carries A, each with its six errors, the tool p0 in the frame of A. The chain is written
/// here, of the motions of single axes: the program has no head.
struct Head {
  RotaryErrors of_c;
  RotaryErrors of_a;
  double c_rad = 45.0 * kDegree;
  double a_rad = -30.0 * kDegree;

  Head() {
    of_c.t_mm = Vector3d(-11.617, -13.502, 0.463) * kUm;
    of_c.w_rad = Vector3d(-11.082, -58.205, 4.265) * kUrad;
    of_a.t_mm = Vector3d(6.0, -9.0, 14.0) * kUm;
    of_a.w_rad = Vector3d(35.0, -20.0, 12.0) * kUrad;
  }
  /// With commands besides the nominal angles.
  [[nodiscard]] Eigen::Isometry3d actual(double dc_rad = 0.0, double da_rad = 0.0) const {
    return rotary_motion(kC, c_rad + dc_rad, of_c) * rotary_motion(kA, a_rad + da_rad, of_a);
  }
  [[nodiscard]] Eigen::Isometry3d nominal() const {
    return rotary_motion(kC, c_rad, {}) * rotary_motion(kA, a_rad, {});
  }
};

TEST(RotaryAxes, TwoAxesInAChainErrAsTheWorkedCase) {
  const Head head;
  struct Row {
    Vector3d p0;
    Vector3d dp_um;
    Vector3d linear_um;
  };
  const double dc_rad = -0.00024437 * kDegree;
  const double da_rad = -0.00200535 * kDegree;
  for (const Row& row :
       {Row{{0, 0, -200}, {8.3832, -9.6563, 15.8633}, {-12.369, 14.2448, -19.3623}},
        Row{{0, 60, -250}, {11.5621, -7.9280, 15.4861}, {-17.4434, 14.2492, -18.0414}}}) {
    SCOPED_TRACE(row.p0.y());
    const Vector3d at = head.nominal() * row.p0;
    EXPECT_LT(((head.actual() * row.p0 - at) / kUm - row.dp_um).cwiseAbs().maxCoeff(), 5.1e-5);
    // What the commands leave, the linear axes moved as printed.
    const Vector3d left_um = (head.actual(dc_rad, da_rad) * row.p0 - at) / kUm + row.linear_um;
    EXPECT_LT((left_um - Vector3d(-0.0010, 0.0002, 0.0011)).cwiseAbs().maxCoeff(),
              row.p0.y() == 0.0 ? 5.1e-4 : 5e-3)
        << left_um.transpose();
  }
  // To first order, of A.
  const Vector3d q = head.nominal() * Vector3d(0, 0, -200);
  const Vector3d arm = kA.turn(head.a_rad) * Vector3d(0, 0, -200);
  const Vector3d first = head.of_c.t_mm + head.of_c.w_rad.cross(q) +
                         kC.turn(head.c_rad) * (head.of_a.t_mm + head.of_a.w_rad.cross(arm));
  EXPECT_LT((first / kUm - Vector3d(8.3840, -9.6566, 15.8623)).cwiseAbs().maxCoeff(), 5.1e-5);
  EXPECT_NEAR(-head.of_c.w_rad.z(), dc_rad, 1e-10);
  EXPECT_NEAR(-head.of_a.w_rad.x(), da_rad, 1e-10);
  const Matrix3d left = head.actual(dc_rad, da_rad).linear() * head.nominal().linear().transpose();
  EXPECT_LT((rotation_vector(left) / kUrad - Vector3d(3.06, -72.35, 12.00)).cwiseAbs().maxCoeff(),
            0.0051)
      << rotation_vector(left).transpose() / kUrad;
  const Vector3d n = head.nominal().linear() * -Vector3d::UnitZ();
  EXPECT_LT(((left * n - n) / kUrad - Vector3d(66.90, 6.89, 24.50)).cwiseAbs().maxCoeff(), 0.0051)
      << ((left * n - n) / kUrad).transpose();
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
  // A drift that no ball alone shows: the mean of all does.
  m = good();
  EXPECT_FALSE(warned("together"));
  for (BallCentre& ball : m.references[2]) {
    ball.centre_mm.x() += 4.0 * ball.u_mm.maxCoeff();
  }
  study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  EXPECT_FALSE(warned("the reference pose drifts by"));
  EXPECT_TRUE(warned("all balls together drift"));
  m.references.resize(1);
  study = identify_rotary_axis(m);
  ASSERT_TRUE(study);
  EXPECT_TRUE(warned("measured 1 time"));
}

}  // namespace
}  // namespace rondure::fit
