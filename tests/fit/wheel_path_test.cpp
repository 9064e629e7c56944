// Wheel-centre path: worked examples 3 and 4, a brute-force envelope, gouging, residual form.

#include "fit/wheel/path.h"
#include "fit/wheel/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/wheel/evaluation.h"

namespace rondure::fit {
namespace {

using ::testing::HasSubstr;

WheelSurface example_3() { return WheelSurface::asphere({1.0 / 120.0, -1.0, {0.0, 2e-8}}).value(); }

WheelSurface parabola(double radius) {
  return WheelSurface::polynomial({{0.0, 0.0, 0.5 / radius}}).value();
}

/// f = 3 exp(-((x - 15) / 5)^2) as a table.
WheelSurface bump() {
  std::vector<double> x;
  std::vector<double> z;
  for (double at = -5.0; at <= 35.0 + 1e-9; at += 0.1) {
    x.push_back(at);
    z.push_back(3.0 * std::exp(-std::pow((at - 15.0) / 5.0, 2)));
  }
  return WheelSurface::table(x, z).value();
}

WheelPathOptions range(double from, double to, double step) {
  WheelPathOptions out;
  out.from_mm = from;
  out.to_mm = to;
  out.step_mm = step;
  return out;
}

/// The ground surface at x: the lowest that any wheel of the path reaches there.
double envelope(const WheelPath& path, double radius, double x) {
  double z = std::numeric_limits<double>::infinity();
  for (const WheelPathRow& row : path.rows) {
    const double dx = x - row.center_mm.x();
    if (std::abs(dx) >= radius) continue;
    z = std::min(z, row.center_mm.y() - std::sqrt(radius * radius - dx * dx));
  }
  return z;
}

TEST(WheelPath, GivesTheTableOfWorkedExample3) {
  const auto path = wheel_path(example_3(), 49.9832, range(-40.0, 40.0, 10.0));
  ASSERT_TRUE(path) << path.error().what;
  ASSERT_EQ(path->rows.size(), 9U);
  struct Row {
    double x, f, slope, second, q, concave, load, xc, zc;
  };
  const std::array<Row, 5> rows = {{
      {0, 0.000000, 0.000000000, 0.008333333, 1.000000000, 120.0000, 0.416527, 0.000000, 49.983200},
      {10, 0.416867, 0.083413333, 0.008357333, 1.003472862, 120.9064, 0.413404, 5.845164,
       50.227083},
      {20, 1.669867, 0.167306667, 0.008429333, 1.013899167, 123.6491, 0.404234, 11.752116,
       50.967866},
      {30, 3.766200, 0.252160000, 0.008549333, 1.031302412, 128.2998, 0.389581, 17.778790,
       52.232294},
      {40, 6.717867, 0.338453333, 0.008717333, 1.055722813, 134.9790, 0.370304, 23.975926,
       54.062870},
  }};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].x);
    const WheelPathRow& row = path->rows[4 + i];
    EXPECT_NEAR(row.x_mm, rows[i].x, 1e-12);
    EXPECT_NEAR(row.surface.height_mm, rows[i].f, 5.1e-7);
    EXPECT_NEAR(row.surface.slope, rows[i].slope, 5.1e-10);
    EXPECT_NEAR(row.surface.second_per_mm, rows[i].second, 5.1e-10);
    EXPECT_NEAR(row.surface.stretch(), rows[i].q, 5.1e-10);
    EXPECT_NEAR(1.0 / row.surface.curvature_per_mm(), rows[i].concave, 5.1e-5);
    EXPECT_NEAR(row.load, rows[i].load, 5.1e-7);
    EXPECT_NEAR(row.center_mm.x(), rows[i].xc, 5.1e-7);
    EXPECT_NEAR(row.center_mm.y(), rows[i].zc, 5.1e-7);
    EXPECT_NEAR(row.contact_rad, std::atan(rows[i].slope), 1e-9);
    EXPECT_NEAR(row.clearance_mm, 0.0, 1e-9);
    const WheelPathRow& mirrored = path->rows[4 - i];
    EXPECT_NEAR(mirrored.center_mm.x(), -row.center_mm.x(), 1e-12);
    EXPECT_NEAR(mirrored.center_mm.y(), row.center_mm.y(), 1e-12);
  }
  EXPECT_NEAR(path->load.load, 0.416527, 5.1e-7);
  EXPECT_NEAR(path->load.x_mm, 0.0, 1e-3);
}

TEST(WheelPath, EnvelopeOfTheWheelIsTheSurface) {
  std::vector<double> x;
  std::vector<double> z;
  for (double at = -60.0; at <= 60.0 + 1e-9; at += 2.0) {
    x.push_back(at);
    z.push_back(example_3().at(at)->height_mm);
  }
  const auto table = WheelSurface::table(x, z).value();
  const auto ramp = WheelSurface::polynomial({{1.0, -0.2, -0.004, 2e-5}}).value();
  for (const WheelSurface& surface : {example_3(), table, ramp, parabola(40.0)}) {
    const double radius = 30.0;
    const auto path = wheel_path(surface, radius, range(-40.0, 40.0, 0.01));
    ASSERT_TRUE(path) << path.error().what;
    for (double at = -38.0; at <= 38.0; at += 4.75) {
      SCOPED_TRACE(at);
      EXPECT_NEAR(envelope(*path, radius, at), surface.at(at)->height_mm, path->cusp_mm + 1e-9);
    }
  }
}

TEST(WheelPath, LeavesTheResidualFormOfTheTable) {
  const auto options = range(-60.0, 60.0, 0.01);
  const double truth = 49.9832;
  struct Row {
    double used;
    std::array<double, 3> vertical;  // um at x = 0, 20, 40
    std::array<double, 4> touched;   // um at x = 10, 20, 30, 40
  };
  for (const Row& row : {Row{50.0, {16.800, 17.034, 17.736}, {0.058, 0.234, 0.526, 0.936}},
                         Row{49.9842, {1.000, 1.014, 1.056}, {0.003, 0.014, 0.031, 0.056}},
                         Row{49.9832, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}}}) {
    SCOPED_TRACE(row.used);
    const auto path = wheel_path(example_3(), row.used, options);
    ASSERT_TRUE(path) << path.error().what;
    auto coarse = range(-40.0, 40.0, 10.0);
    const auto form = residual_form(example_3(), row.used, truth, 0.0, coarse);
    ASSERT_TRUE(form) << form.error().what;
    ASSERT_EQ(form->rows.size(), 9U);
    for (std::size_t i = 0; i < 3; ++i) {
      const ResidualRow& found = form->rows[4 + 2 * i];
      EXPECT_NEAR(found.vertical_mm * 1e3, row.vertical[i], 5.1e-4);
      // The wheel itself along the path, against the formula: the cusps and O(delta^2 k) remain.
      const double ground = envelope(*path, truth, found.x_mm);
      EXPECT_NEAR(ground - example_3().at(found.x_mm)->height_mm, found.vertical_mm, 3e-6);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(form->rows[5 + i].touched_mm * 1e3, row.touched[i], 5.1e-4);
    }
    EXPECT_NEAR(form->deviation_mm, std::abs(form->rows.back().touched_mm), 1e-15);
  }
}

TEST(WheelPath, RefusesAWheelThatIsTooLargeForTheHollow) {
  const auto options = range(-20.0, 20.0, 0.5);
  ASSERT_TRUE(wheel_path(parabola(40.0), 30.0, options));
  EXPECT_NEAR(wheel_load(parabola(40.0), 30.0, options)->load, 0.75, 1e-12);
  const auto margin = wheel_path(parabola(40.0), 39.9, options);
  ASSERT_FALSE(margin);
  EXPECT_EQ(margin.error().code, core::Code::kGouge);
  EXPECT_THAT(margin.error().what, HasSubstr("0.9975 of the concave radius of curvature 40 mm"));
  const auto gouge = wheel_path(parabola(40.0), 45.0, options);
  ASSERT_FALSE(gouge);
  EXPECT_EQ(gouge.error().code, core::Code::kGouge);
  EXPECT_THAT(gouge.error().what,
              HasSubstr("45 mm exceeds the concave radius of curvature 40 mm at x = 0 mm"));
  const auto close = wheel_path(parabola(40.0), 38.0, options);
  ASSERT_TRUE(close);
  ASSERT_EQ(close->warnings.size(), 1U);
  EXPECT_EQ(close->warnings.front().code, core::Code::kLowMargin);
}

TEST(WheelPath, FormulaPathOfTooLargeAWheelCutsAsDeepAsTheMethodSays) {
  // Refused by wheel_path(); the formula alone shows why.
  WheelPath path;
  for (double x = -40.0; x <= 40.0; x += 0.01) {
    const SurfacePoint p = *parabola(40.0).at(x);
    WheelPathRow row;
    row.center_mm = {x - 45.0 * p.slope / p.stretch(), p.height_mm + 45.0 / p.stretch()};
    path.rows.push_back(row);
  }
  const std::array<std::array<double, 2>, 4> cut = {{{0, 89}, {2, 136}, {5, 227}, {10, 426}}};
  for (const auto& [x, um] : cut) {
    const double depth = parabola(40.0).at(x)->height_mm - envelope(path, 45.0, x);
    EXPECT_NEAR(depth * 1e3, um, 0.51) << x;
  }
}

TEST(WheelPath, SeesTheWheelInsideTheSurfaceFarFromItsContact) {
  const WheelSurface surface = bump();
  auto options = range(0.0, 30.0, 0.1);
  const SurfacePoint p = *surface.at(0.0);
  EXPECT_NEAR(50.0 * p.curvature_per_mm(), 0.025, 1e-3);
  const Eigen::Vector2d center(-50.0 * p.slope / p.stretch(), p.height_mm + 50.0 / p.stretch());
  const auto samples = SurfaceSamples::over(surface, 0.0, 30.0);
  ASSERT_TRUE(samples) << samples.error().what;
  const SurfaceSamples::Place nearest = samples->nearest(center, 100.0);
  EXPECT_NEAR(50.0 - nearest.value, 0.849, 5.1e-4);
  EXPECT_NEAR(nearest.x_mm, 13.70, 6e-3);
  const auto local = wheel_path(surface, 50.0, options);
  ASSERT_FALSE(local);
  EXPECT_THAT(local.error().what, HasSubstr("concave radius of curvature 10.6895 mm"));
  EXPECT_THAT(local.error().what, HasSubstr("x = 8.5 mm"));
  // Contacts on the level part only, but the bump is there: seen by the clearance alone.
  options = range(-5.0, 0.0, 0.1);
  ASSERT_TRUE(wheel_path(surface, 9.0, options));
  const auto step = WheelSurface::polynomial({{0, 0, 0, 0, 0, 0, 1e-6}}).value();
  auto wide = range(-1.0, 1.0, 0.1);
  ASSERT_TRUE(wheel_path(step, 9.0, wide));
  wide.load_limit = 1.0;
  wide.surface_from_mm = -9.5;
  wide.surface_to_mm = 9.5;
  const auto wall = wheel_path(step, 9.0, wide);
  ASSERT_FALSE(wall);
  EXPECT_EQ(wall.error().code, core::Code::kGouge);
}

TEST(WheelPath, ClearanceAgreesWithALookAtEveryPlace) {
  const WheelSurface surface = bump();
  const auto samples = SurfaceSamples::over(surface, -5.0, 35.0);
  ASSERT_TRUE(samples);
  for (const double radius : {5.0, 20.0, 80.0}) {
    for (double at = -4.0; at < 35.0; at += 1.3) {
      const Eigen::Vector2d center(at, radius + 0.3);
      double least = std::numeric_limits<double>::infinity();
      for (double x = -5.0; x <= 35.0; x += 2e-3) {
        least = std::min(least, std::hypot(x - center.x(), surface.at(x)->height_mm - center.y()));
      }
      const double found = samples->nearest(center, 2.0 * radius).value;
      EXPECT_NEAR(found, least, 1e-6) << radius << " " << at;
      EXPECT_LE(found, least + 1e-12);
    }
  }
}

TEST(WheelPath, KeepsToTheTruedArcAndToTheSurface) {
  auto options = range(-40.0, 40.0, 1.0);
  options.least_contact_rad = -15.0 * core::kDegree;
  options.greatest_contact_rad = 30.0 * core::kDegree;
  const auto arc = wheel_path(example_3(), 49.9832, options);
  ASSERT_FALSE(arc);
  EXPECT_EQ(arc.error().code, core::Code::kWheelArc);
  EXPECT_THAT(arc.error().what, HasSubstr("x = -40 mm"));
  const auto sphere = WheelSurface::asphere({1.0 / 30.0, 0.0, {}}).value();
  const auto beyond = wheel_path(sphere, 20.0, range(-35.0, 35.0, 1.0));
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, core::Code::kSurface);
  EXPECT_THAT(beyond.error().what, HasSubstr("30 mm"));
  const auto outside = wheel_path(bump(), 2.0, range(-10.0, 10.0, 1.0));
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, core::Code::kSurface);
  for (const auto& bad : {range(5.0, 5.0, 1.0), range(0.0, 1.0, 0.0), range(0.0, 1e9, 1e-3)}) {
    const auto refused = wheel_path(parabola(40.0), 20.0, bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kBadOption);
  }
  EXPECT_EQ(wheel_path(parabola(40.0), -1.0, range(0.0, 1.0, 0.1)).error().code,
            core::Code::kBadOption);
}

TEST(WheelPath, ChoosesTheStepFromTheCusp) {
  EXPECT_NEAR(cusp_height_mm(1.0, 50.0, 0.0) * 1e3, 2.500, 5e-4);
  EXPECT_NEAR(cusp_height_mm(1.0, 50.0, 1.0 / 120.0) * 1e3, 1.458, 5e-4);
  EXPECT_NEAR(cusp_height_mm(1.0, 50.0, -1.0 / 120.0) * 1e3, 3.542, 5e-4);
  auto options = range(-30.0, 30.0, 0.0);
  options.cusp_mm = 1e-3;
  const auto path = wheel_path(example_3(), 49.9832, options);
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_LE(path->cusp_mm, 1e-3);
  EXPECT_GT(path->cusp_mm, 0.95e-3);
  double worst = 0.0;
  for (double x = -20.0; x <= 20.0; x += 0.001) {
    worst = std::max(worst, envelope(*path, 49.9832, x) - example_3().at(x)->height_mm);
  }
  EXPECT_LE(worst, 1.05e-3);
  EXPECT_GT(worst, 0.5e-3);
}

TEST(WheelPath, GivesTheLowestPointOnRequest) {
  auto options = range(0.0, 10.0, 5.0);
  options.lowest_point = true;
  const auto path = wheel_path(example_3(), 49.9832, options);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->machine_z_mm(path->rows.front()), 0.0, 1e-12);
  EXPECT_NEAR(path->machine_z_mm(path->rows.back()), 50.227083 - 49.9832, 5.1e-7);
}

TEST(WheelSurface, DerivativesAreThoseOfTheHeights) {
  std::vector<double> x;
  std::vector<double> z;
  for (double at = -20.0; at <= 20.0; at += 1.25) {
    x.push_back(at + 0.2 * std::sin(at));
    z.push_back(std::cos(x.back() / 6.0));
  }
  const auto asphere = WheelSurface::asphere({-1.0 / 55.0, 0.7, {1e-4, -3e-7, 2e-10}}).value();
  const auto polynomial = WheelSurface::polynomial({{1.0, 0.2, -0.01, 3e-4, 1e-6}}).value();
  for (const auto& surface : {asphere, polynomial, WheelSurface::table(x, z).value(),
                              polynomial.less(x, std::vector<double>(x.size(), 0.25)).value()}) {
    constexpr double kStep = 1e-4;
    for (double at = -19.0; at < 19.0; at += 0.77) {
      const SurfacePoint low = *surface.at(at - kStep);
      const SurfacePoint high = *surface.at(at + kStep);
      const SurfacePoint here = *surface.at(at);
      EXPECT_NEAR(here.slope, (high.height_mm - low.height_mm) / (2.0 * kStep), 1e-7);
      EXPECT_NEAR(here.second_per_mm, (high.slope - low.slope) / (2.0 * kStep), 1e-5);
    }
  }
}

TEST(WheelSurface, TableReproducesACubicAndItsCurvatureUpToTheEnds) {
  const auto cubic = WheelSurface::polynomial({{1.0, -0.3, 0.02, 5e-4}}).value();
  std::vector<double> x;
  std::vector<double> z;
  for (const double at : {-10.0, -8.5, -4.0, 0.0, 1.0, 5.5, 10.0}) {
    x.push_back(at);
    z.push_back(cubic.at(at)->height_mm);
  }
  const auto table = WheelSurface::table(x, z).value();
  for (double at = -10.0; at <= 10.0; at += 0.5) {
    EXPECT_NEAR(table.at(at)->height_mm, cubic.at(at)->height_mm, 1e-13);
    EXPECT_NEAR(table.at(at)->second_per_mm, cubic.at(at)->second_per_mm, 1e-13);
  }
}

TEST(WheelSurface, RemovalAddsTheCurvatureOfItsWaves) {
  // h = a/2 (1 + cos(2 pi x / p)), a = 2 um, p = 4 mm on a plane: radius 405 mm.
  std::vector<double> x;
  std::vector<double> h;
  for (double at = -8.0; at <= 8.0 + 1e-9; at += 0.1) {
    x.push_back(at);
    h.push_back(1e-3 * (1.0 + std::cos(core::kTwoPi * at / 4.0)));
  }
  const auto plane = WheelSurface::polynomial({{0.0}}).value();
  const auto load = wheel_load(plane.less(x, h).value(), 50.0, range(-7.0, 7.0, 0.1));
  ASSERT_TRUE(load) << load.error().what;
  EXPECT_NEAR(load->load / 50.0, 0.00247, 1e-5);
  EXPECT_NEAR(load->concave_radius_mm(50.0), 405.0, 2.0);
}

TEST(WheelSurface, RefusesTablesThatAreNone) {
  using core::Code;
  EXPECT_EQ(WheelSurface::table({0, 1, 2, 3}, {0, 0, 0, 0}).error().code, Code::kTable);
  const double nothing = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(WheelSurface::table({0, nothing, 1, 2, 3}, {0, 1, 0, 0, 0}).error().code, Code::kTable);
  const auto order = WheelSurface::table({0, 1, 1, 3, 4}, {0, 0, 0, 0, 0});
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().code, Code::kTable);
  EXPECT_THAT(order.error().what, HasSubstr("row 2"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto hole = WheelSurface::table({0, 1, 2, 3, 4}, {0, 0, 0, nan, 0});
  ASSERT_FALSE(hole);
  EXPECT_EQ(hole.error().code, Code::kNotFinite);
  EXPECT_THAT(hole.error().what, HasSubstr("row 3"));
  EXPECT_EQ(WheelSurface::polynomial({{}}).error().code, Code::kBadOption);
  EXPECT_EQ(WheelSurface::asphere({nan, 0.0, {}}).error().code, Code::kBadOption);
  EXPECT_EQ(parabola(40.0).less({0, 1, 2, 3, 4}, {0, 0, -1e-3, 0, 0}).error().code, Code::kSurface);
}

TEST(WheelForecast, NamesTheImprovementAndItsCap) {
  ForecastInput input;
  input.radius_mm = 49.9832;
  input.radius_uncertainty_mm = 0.5e-3;
  input.nominal_radius_mm = 50.0;
  const auto options = range(-40.0, 40.0, 1.0);
  const auto free = forecast(example_3(), input, options);
  ASSERT_TRUE(free) << free.error().what;
  ASSERT_TRUE(free->improvement);
  EXPECT_NEAR(*free->improvement, 16.8, 1e-6);
  EXPECT_FALSE(free->capped);
  EXPECT_NEAR(free->nominal->deviation_mm * 1e3, 0.936, 5.1e-4);
  EXPECT_NEAR(free->measured.deviation_mm * 1e3, 0.056, 5.1e-4);
  input.repeatability_mm = 4e-3;
  const auto capped = forecast(example_3(), input, options);
  ASSERT_TRUE(capped);
  EXPECT_TRUE(capped->capped);
  EXPECT_NEAR(*capped->improvement, 4.2, 1e-6);
  input.nominal_radius_mm.reset();
  EXPECT_FALSE(forecast(example_3(), input, options)->improvement);
}

}  // namespace
}  // namespace rondure::fit
