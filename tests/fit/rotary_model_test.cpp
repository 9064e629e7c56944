// Rotary axes, sections 6 and 7 of the method specification: place of the axis, and errors between
// the stations.
#include "fit/rotary/model.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/decompositions.h"
#include "fit/rotary/axes.h"
#include "tests/fit/rotary_cases.h"
#include "tests/fit/spec_cases.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;
using Eigen::Vector3d;
using test::angles_deg;
using test::circle_of;
using test::draw;
using test::example;
using test::example_errors;
using test::five_balls;
using test::fixture_errors;
using test::kA;
using test::kC;
using test::kUm;
using test::kUrad;
using test::measured;
using test::no_errors;
using ::testing::HasSubstr;

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
    const Eigen::VectorXd second = core::solve_pivoted_qr(m, right);
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

}  // namespace
}  // namespace rondure::fit
