#include "plans/path/obstacle.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "tests/plans/random_inspection.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using test::between;

Vector3d vector(core::KeyedNoise& random, double size) {
  return {between(random, -size, size), between(random, -size, size), between(random, -size, size)};
}

/// Least distance over a dense grid of the parallelogram: never below the true one, above it by
/// less than half a cell's diagonal.
struct Sampled {
  double least_mm = 0.0;
  double slack_mm = 0.0;
};

Sampled sampled(const Revolved& solid, const Sweep& sweep) {
  constexpr int kSteps = 60;
  Sampled out{1e9, (sweep.along_mm.norm() + sweep.up_mm.norm()) / (2.0 * kSteps)};
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vector3d p = sweep.start_mm + sweep.along_mm * i / kSteps + sweep.up_mm * j / kSteps;
      out.least_mm = std::min(out.least_mm, distance_mm(solid, p));
    }
  }
  return out;
}

Revolved random_solid(core::KeyedNoise& random) {
  Revolved out;
  out.outer_mm = between(random, 5.0, 40.0);
  out.ball = random.uniform() < 0.2;
  if (random.uniform() < 0.4) out.inner_mm = between(random, 0.1, 0.9) * out.outer_mm;
  if (out.ball) out.inner_mm = 0.0;
  out.from_mm = between(random, -30.0, 0.0);
  out.to_mm = out.from_mm + between(random, 1.0, 50.0);
  if (!out.ball && random.uniform() < 0.4) {
    out.widens_mm = between(random, -0.95, 1.5) * (out.outer_mm - out.inner_mm);
  }
  out.touched = random.uniform() < 0.5;
  return out;
}

Sweep random_sweep(core::KeyedNoise& random) {
  Sweep out = {vector(random, 70.0), vector(random, 50.0), vector(random, 50.0)};
  const double kind = random.uniform();
  if (kind < 0.25) out.up_mm.setZero();
  if (kind < 0.05) out.along_mm.setZero();
  if (kind > 0.85) out.up_mm = between(random, -2.0, 2.0) * out.along_mm;  // flat
  return out;
}

TEST(Obstacle, NeverOverlooksAndSeldomExaggerates) {
  int near_misses = 0;
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {1});
    const Revolved solid = random_solid(random);
    const double room_mm = between(random, 0.3, 12.0);
    const Obstacle obstacle(solid, room_mm);
    for (int k = 0; k < 4; ++k) {
      const Sweep sweep = random_sweep(random);
      const Sampled truth = sampled(solid, sweep);
      const bool meets = obstacle.meets(sweep);
      if (truth.least_mm < room_mm - 2e-6) {
        ASSERT_TRUE(meets) << "a sampled place is " << truth.least_mm << " mm off";
        ++hits;
      }
      if (truth.least_mm - truth.slack_mm > 1.04 * room_mm + 0.05) {
        ASSERT_FALSE(meets) << "no place is nearer than " << truth.least_mm - truth.slack_mm;
        ++near_misses;
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(near_misses, 300);
}

TEST(Obstacle, OfAFrustumHasTheDistanceOfItsWall) {
  const Revolved frustum = {0.0, 10.0, 0.0, 10.0, false, 10.0};  // 45 deg
  EXPECT_NEAR(distance_mm(frustum, {0.0, 17.0, 5.0}), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(distance_mm(frustum, {-21.0, 0.0, 11.0}), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(distance_mm(frustum, {3.0, 0.0, 12.5}), 2.5, 1e-12);
  EXPECT_EQ(distance_mm(frustum, {14.0, 0.0, 5.0}), 0.0);
  const Obstacle grown(frustum, 2.0);
  const Vector3d along(0.0, 10.0, 10.0);  // beside the wall
  EXPECT_TRUE(grown.meets({{0.0, 10.0 + 2.7, 0.0}, along, Vector3d::Zero()}));
  EXPECT_FALSE(grown.meets({{0.0, 10.0 + 2.95, 0.0}, along, Vector3d::Zero()}));
}

TEST(Obstacle, MayBeFollowedAtItsVeryDistance) {
  const Obstacle shaft({0.0, 25.0, -40.0, 40.0, false}, 7.0);
  EXPECT_FALSE(shaft.meets({{32.0, 0.0, -35.0}, {0.0, 0.0, 70.0}, Vector3d::Zero()}));
  EXPECT_FALSE(shaft.meets({{-60.0, 3.0, 47.0}, {120.0, 0.0, 0.0}, Vector3d::Zero()}));
  EXPECT_TRUE(shaft.meets({{31.99, 0.0, -35.0}, {0.0, 0.0, 70.0}, Vector3d::Zero()}));
}

TEST(Obstacle, LetsTheToolIntoAHoleThatIsWideEnough) {
  const Revolved ring = {20.0, 35.0, -10.0, 10.0, false};
  const Sweep down = {{5.0, 0.0, 80.0}, {0.0, 0.0, -160.0}, Vector3d::Zero()};
  EXPECT_FALSE(Obstacle(ring, 14.9).meets(down));
  EXPECT_TRUE(Obstacle(ring, 15.1).meets(down));
  EXPECT_TRUE(Obstacle(ring, 21.0).meets(down)) << "a hole that the room fills is no hole";
}

TEST(Obstacle, SeesAMoveThatPassesRightThrough) {
  const Obstacle plate({0.0, 30.0, 0.0, 0.5, false}, 0.25);
  EXPECT_TRUE(plate.meets({{1.0, 2.0, -50.0}, {0.0, 0.0, 100.0}, Vector3d::Zero()}));
  EXPECT_TRUE(plate.meets({{-80.0, 2.0, -50.0}, {160.0, 0.0, 0.0}, {0.0, 0.0, 100.0}}));
}

TEST(Obstacle, HoldsWhatLiesWhollyInsideIt) {
  const Obstacle part({0.0, 30.0, -50.0, 50.0, false}, 5.0);
  EXPECT_TRUE(part.meets({{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 3.0}}));
  EXPECT_TRUE(part.meets({{1.0, 0.0, 0.0}, Vector3d::Zero(), Vector3d::Zero()}));
}

}  // namespace
}  // namespace rondure::plans
