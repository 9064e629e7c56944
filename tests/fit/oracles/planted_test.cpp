// The planted sets keep what they state: the generator tested by means that share nothing with it,
// and the independent descent tested by sets it has not seen.
#include "planted.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "dial.h"

namespace rondure::test {
namespace {

struct Kind {
  Reference reference;
  bool curved;
};
constexpr Kind kCylinders[] = {
    {Reference::kMinZone, false},       {Reference::kMinZone, true},
    {Reference::kCircumscribed, false}, {Reference::kCircumscribed, true},
    {Reference::kInscribed, false},     {Reference::kInscribed, true}};

Plot plot_of(const Kind& kind, std::uint64_t seed) {
  Plot plot = draw_plot(kind.reference, seed);
  plot.curved = kind.curved;
  // An inscribed cylinder is held by curvature where tilting matters more than moving: a disc.
  if (kind.curved && kind.reference == Reference::kInscribed) plot.half_length_mm *= 0.2;
  return plot;
}

Real stated_value(const Optimum& optimum, Reference reference) {
  return Extremes{optimum.inner_mm, optimum.outer_mm}.value_mm(reference);
}

/// Contacts on their radius, all others strictly inside: distances of the plane and of space.
template <class Distance>
void expect_touching(const Optimum& optimum, std::size_t points, double unit,
                     const Distance& distance) {
  for (std::size_t i = 0; i < points; ++i) {
    const double r = distance(i);
    const double low = optimum.inner_mm > 0.0 ? r - optimum.inner_mm : 1e300;
    const double high = optimum.outer_mm > 0.0 ? optimum.outer_mm - r : 1e300;
    const bool contact = std::count(optimum.contacts.begin(), optimum.contacts.end(), i) > 0;
    if (contact) {
      EXPECT_LE(std::min(std::abs(low), std::abs(high)), unit);
    } else {
      EXPECT_GT(std::min(low, high), 0.01 * optimum.form_mm);
    }
  }
}

TEST(Planted, CirclesHoldTheirPointsAndGrowAsStated) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Plot plot = draw_plot(static_cast<Reference>(seed % 3), seed);
    const PlantedCircle set = plant_circle(plot, seed);
    const double unit = 8e-16 * (plot.offset_mm + plot.radius_mm);
    expect_touching(set.optimum, set.points.size(), unit,
                    [&](std::size_t i) { return (set.points[i] - set.center_mm).norm(); });
    core::KeyedNoise noise(seed, {91});
    const double ball = set.optimum.growth * plot.radius_mm / 2.0;
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector2d step(noise.normal(), noise.normal());
      const double size = ball * std::pow(10.0, -5.0 * noise.uniform());
      const Eigen::Vector2d moved = step / step.cwiseAbs().maxCoeff() * size;
      const Real grown =
          extremes(set.points, (set.center_mm + moved).cast<Real>()).value_mm(plot.reference) -
          stated_value(set.optimum, plot.reference);
      EXPECT_GE(grown, 0.4L * set.optimum.growth * size - 10.0L * unit);
    }
  }
}

/// The move that costs least, along each of many random lines through the optimum.
void expect_growth(const PlantedCylinder& set, const Plot& plot, std::uint64_t seed, double unit) {
  core::KeyedNoise noise(seed, {92});
  const Eigen::Vector3d u = set.direction.unitOrthogonal();
  const Eigen::Vector3d v = set.direction.cross(u);
  const double bent = 1.0 / plot.radius_mm + plot.radius_mm / std::pow(plot.half_length_mm, 2);
  const double ball = plot.curved ? set.optimum.form_mm : set.optimum.growth / (10.0 * bent);
  for (int k = 0; k < 100; ++k) {
    Eigen::Vector4d x(noise.normal(), noise.normal(), noise.normal(), noise.normal());
    x *= ball * std::pow(10.0, -4.0 * noise.uniform()) / x.cwiseAbs().maxCoeff();
    const Eigen::Vector3d tilt = (x(2) * u + x(3) * v) / plot.half_length_mm;
    const Real grown = extremes(set.points, (set.center_mm + x(0) * u + x(1) * v).cast<Real>(),
                                (set.direction + tilt).cast<Real>())
                           .value_mm(plot.reference) -
                       stated_value(set.optimum, plot.reference);
    // max|x| is not invariant under a turn of u and v: within a factor of sqrt 2.
    const double size = x.cwiseAbs().maxCoeff();
    const double least = plot.curved ? 0.0 : 0.5 * set.optimum.growth * size;
    EXPECT_GE(grown, least - 10.0 * unit);
  }
}

TEST(Planted, CylindersHoldTheirPointsAndGrowAsStated) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Plot plot = plot_of(kCylinders[seed % 6], seed);
    const PlantedCylinder set = plant_cylinder(plot, seed);
    const double unit = 8e-16 * (plot.offset_mm + plot.radius_mm + plot.half_length_mm);
    expect_touching(set.optimum, set.points.size(), 2.0 * unit, [&](std::size_t i) {
      return (set.points[i] - set.center_mm).cross(set.direction).norm();
    });
    EXPECT_EQ(set.optimum.curvature > 0.0, plot.curved);
    expect_growth(set, plot, seed, unit);
  }
}

TEST(Planted, DescentFindsPlantedCircles) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(300)); ++seed) {
    SCOPED_TRACE(seed);
    const Plot plot = draw_plot(static_cast<Reference>(seed % 3), seed);
    const PlantedCircle set = plant_circle(plot, seed);
    const double away = 3.0 * set.optimum.form_mm;
    const CircleOptimum found =
        descend(set.points, (set.center_mm + Eigen::Vector2d(away, away)).cast<Real>(),
                plot.reference, away);
    EXPECT_NEAR(static_cast<double>(found.at.value_mm(plot.reference) -
                                    stated_value(set.optimum, plot.reference)),
                0.0, 1e-12);
    EXPECT_LT((found.center_mm.cast<double>() - set.center_mm).norm(), 1e-10);
  }
}

TEST(Planted, DescentFindsPlantedCylinders) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(300)); ++seed) {
    SCOPED_TRACE(seed);
    const Plot plot = plot_of(kCylinders[seed % 6], seed);
    const PlantedCylinder set = plant_cylinder(plot, seed);
    const double away = 2.0 * set.optimum.form_mm;
    const Eigen::Vector3d u = set.direction.unitOrthogonal();
    const AxisOptimum found =
        descend(set.points, (set.center_mm + away * u).cast<Real>(),
                (set.direction + away / plot.half_length_mm * set.direction.cross(u)).cast<Real>(),
                plot.reference, away);
    EXPECT_NEAR(static_cast<double>(found.at.value_mm(plot.reference) -
                                    stated_value(set.optimum, plot.reference)),
                0.0, 3e-12);
  }
}

}  // namespace
}  // namespace rondure::test
