#include "cmm/simulated/internal/surface_shape.h"

#include <cmath>

#include <gtest/gtest.h>

#include "random_parts.h"

namespace rondure::cmm {
namespace {

TEST(PartSurface, FollowsTheFormulaOfTheMethod) {
  // Case A of the method, F = 10 um: radius = 25 + 0.01 v / 3.4.
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 40.0;
  const double unit = 0.01 / 3.4;
  part.form.lobes = {{2, unit, 0.3, 0.5}, {3, 0.6 * unit, 1.1, -0.4}, {5, 0.4 * unit, 2.0, 0.0}};
  part.form.taper_mm = 0.6 * unit;
  part.form.barrel_mm = 0.9 * unit;
  part.form.bend_mm = 1.2 * unit;
  part.form.bend_phase_rad = 0.7;
  for (const double z : {-40.0, -12.5, 0.0, 31.0}) {
    for (const double t : {0.0, 1.0, 2.5, 6.0}) {
      const double q = z / 40.0;
      const double b = q * q - 1.0 / 3.0;
      const double v = std::cos(2 * t + 0.3 + 0.5 * q) + 0.6 * std::cos(3 * t + 1.1 - 0.4 * q) +
                       0.4 * std::cos(5 * t + 2.0) + 0.6 * q + 0.9 * b +
                       1.2 * b * std::cos(t + 0.7);
      EXPECT_NEAR(part.radius_at(t, z), 25.0 + unit * v, 1e-14);
    }
  }
}

TEST(SurfaceShape, DerivativesAgreeWithDifferences) {
  core::KeyedNoise random(1, {1});
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(draw);
    PartSurface part = random_part(random, draw % 4 == 3, 10.0);
    const double t = between(random, 0.0, core::kTwoPi);
    const double z = between(random, -part.half_length_mm, part.half_length_mm);
    // Half of the draws lie on a burr, mostly on its flanks.
    if (draw % 2 == 1) {
      part.marks = {{t + between(random, -2.0, 2.0) / part.radius_mm,
                     z + between(random, -2.0, 2.0), 5.0, 5.0, 0.05, 2.4}};
    }
    const double h = 1e-5;
    const auto at = [&](double dt, double dz) {
      return radius_derivatives(part, t + dt * h, z + dz * h);
    };
    const RadiusDerivatives d = at(0, 0);
    const double tolerance = part.marks.empty() ? 1e-7 : 2e-5;  // a flank bends far more
    EXPECT_NEAR(d.t, (at(1, 0).r_mm - at(-1, 0).r_mm) / (2 * h), tolerance);
    EXPECT_NEAR(d.z, (at(0, 1).r_mm - at(0, -1).r_mm) / (2 * h), tolerance);
    EXPECT_NEAR(d.tt, (at(1, 0).t - at(-1, 0).t) / (2 * h), tolerance);
    EXPECT_NEAR(d.tz, (at(0, 1).t - at(0, -1).t) / (2 * h), tolerance);
    EXPECT_NEAR(d.zz, (at(0, 1).z - at(0, -1).z) / (2 * h), tolerance);
  }
}

TEST(SurfaceShape, JetAgreesWithDifferences) {
  core::KeyedNoise random(2, {1});
  for (int draw = 0; draw < 100; ++draw) {
    SCOPED_TRACE(draw);
    const PartSurface part = random_part(random, false, 10.0);
    const double u = between(random, 0.0, core::kTwoPi * part.radius_mm);
    const double z = between(random, -part.half_length_mm, part.half_length_mm);
    const double h = 1e-5;
    const SurfaceJet jet = surface_jet(part, u, z);
    const SurfaceJet u1 = surface_jet(part, u + h, z);
    const SurfaceJet u0 = surface_jet(part, u - h, z);
    const SurfaceJet z1 = surface_jet(part, u, z + h);
    const SurfaceJet z0 = surface_jet(part, u, z - h);
    EXPECT_LT((jet.u - (u1.x_mm - u0.x_mm) / (2 * h)).norm(), 1e-8);
    EXPECT_LT((jet.z - (z1.x_mm - z0.x_mm) / (2 * h)).norm(), 1e-8);
    EXPECT_LT((jet.uu - (u1.u - u0.u) / (2 * h)).norm(), 1e-8);
    EXPECT_LT((jet.uz - (z1.u - z0.u) / (2 * h)).norm(), 1e-8);
    EXPECT_LT((jet.zz - (z1.z - z0.z) / (2 * h)).norm(), 1e-8);
  }
}

TEST(SurfaceShape, BoundsHoldEverywhere) {
  core::KeyedNoise random(3, {1});
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(draw);
    PartSurface part = random_part(random, false, 20.0);
    if (draw % 2 == 1) part.marks = {{1.0, 0.0, 20.0, 30.0, draw % 4 == 1 ? 0.3 : -0.3, 4.0}};
    const ShapeBounds bounds = shape_bounds(part);
    for (int sample = 0; sample < 2000; ++sample) {
      const double t = between(random, 0.0, core::kTwoPi);
      const double z = between(random, -part.half_length_mm, part.half_length_mm);
      const SurfaceJet jet = surface_jet(part, t * part.radius_mm, z);
      ASSERT_LE(std::abs(part.radius_at(t, z) - part.radius_mm), bounds.deviation_mm);
      ASSERT_LE(jet.u.norm(), bounds.stretch_u);
      ASSERT_LE(jet.z.norm(), bounds.stretch_z);
    }
  }
}

TEST(SurfaceShape, BoundsInABoxHoldInIt) {
  core::KeyedNoise random(3, {2});
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(draw);
    PartSurface part = random_part(random, draw % 2 == 1, 20.0);
    // Two marks that cross, one of them over the angle where the turn begins; steep flanks.
    const double height_mm = draw % 3 == 0 ? 4.0 : -4.0;
    part.marks = {{0.1, 2.0, 8.0, 10.0, height_mm, 0.2}, {0.2, -4.0, 6.0, 9.0, -2.0, 1.0}};
    const Eigen::Vector2d center(between(random, -1.0, 1.0) * part.radius_mm,
                                 between(random, -12.0, 12.0));
    const Eigen::Vector2d half(between(random, 0.01, 2.0), between(random, 0.01, 2.0));
    const BoxBounds bounds = bounds_in_box(part, bounds_beside_marks(part), center, half);
    for (int sample = 0; sample < 300; ++sample) {
      const double u = center.x() + between(random, -1.0, 1.0) * half.x();
      const double z = center.y() + between(random, -1.0, 1.0) * half.y();
      const SurfaceJet jet = surface_jet(part, u, z);
      ASSERT_LE(jet.u.norm(), bounds.stretch_u * (1.0 + 1e-12));
      ASSERT_LE(jet.z.norm(), bounds.stretch_z * (1.0 + 1e-12));
    }
  }
}

}  // namespace
}  // namespace rondure::cmm
