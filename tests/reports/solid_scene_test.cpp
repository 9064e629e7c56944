#include "reports/html/internal/solid_scene.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "evaluation/results/feature_values.h"
#include "synthetic.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

SolidScene scene_of(const Case& made) {
  const evaluation::FeatureResult& feature = made.evaluation.features[0];
  return solid_scene_of(feature, *zone_of(feature));
}

TEST(SolidScene, EveryPointOfASmallCloudIsDrawnWithinTheZone) {
  const SolidScene scene = scene_of(cylinder_case(4, 7, 1));
  EXPECT_EQ(scene.points.size(), 28U);
  EXPECT_EQ(scene.left_out, 0U);
  for (const SolidPoint& point : scene.points) {
    EXPECT_GE(point.radius, scene.inner - 1e-9);
    EXPECT_LE(point.radius, scene.outer + 1e-9);
    EXPECT_LE(std::abs(point.height), scene.half_height + 1e-9);
  }
}

TEST(SolidScene, AThinnedCloudKeepsEveryContactAndTheFarthestPoints) {
  const Case made = cylinder_case(100, 1000, 1);
  const auto& cloud = made.evaluation.features[0].cloud;
  const SolidScene scene = scene_of(made);
  EXPECT_LE(scene.points.size(), 72U * 24U + 6U);
  EXPECT_EQ(scene.points.size() + scene.left_out, cloud.size());
  std::set<std::size_t> drawn;
  for (const SolidPoint& point : scene.points) drawn.insert(point.row);
  EXPECT_EQ(drawn.size(), scene.points.size());
  double left = 0.0;
  double kept = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool contact = cloud[i].outer_contact || cloud[i].inner_contact;
    EXPECT_TRUE(!contact || drawn.count(i) == 1) << i;
    double& largest = drawn.count(i) == 1 ? kept : left;
    largest = std::max(largest, std::abs(cloud[i].deviation_mm));
  }
  EXPECT_GE(kept, left);
}

TEST(SolidScene, ASectionRunsThroughItsPoints) {
  const SolidScene scene = scene_of(cylinder_case(5, 120, 1));
  ASSERT_EQ(scene.sections.size(), 5U);
  EXPECT_TRUE(scene.dense);
  for (const SolidRing& ring : scene.sections) {
    ASSERT_EQ(ring.radii.size(), 120U);
    for (const double radius : ring.radii) {
      EXPECT_GE(radius, scene.inner - 1e-9);
      EXPECT_LE(radius, scene.outer + 1e-9);
    }
  }
}

TEST(SolidScene, WhereNothingWasMeasuredThereIsNoLine) {
  Case made = cylinder_case(2, 60, 1);
  for (evaluation::CloudPoint& point : made.evaluation.features[0].cloud) point.angle_rad *= 0.5;
  for (const SolidRing& ring : scene_of(made).sections) {
    EXPECT_TRUE(std::isfinite(ring.radii[20]));
    EXPECT_FALSE(std::isfinite(ring.radii[90]));
  }
}

TEST(SolidScene, SeenFromAboveACircleStaysACircle) {
  for (const double angle : {0.0, 77.0, 190.0}) {
    const SolidSeen at = seen({30.0, 90.0}, angle, 50.0, 12.0);
    EXPECT_NEAR(std::hypot(at.x, at.y), 50.0, 1e-9);
  }
}

TEST(SolidScene, TheProjectionIsARotation) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> turn(-180.0, 180.0);
  for (int seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const SolidCamera camera{turn(random), 0.5 * turn(random)};
    // Squared lengths of the images of an orthonormal frame add up to 2 (one direction is lost).
    const SolidSeen x = seen(camera, 0.0, 1.0, 0.0);
    const SolidSeen y = seen(camera, 90.0, 1.0, 0.0);
    const SolidSeen z = seen(camera, 0.0, 0.0, 1.0);
    EXPECT_NEAR(x.x * x.x + y.x * y.x + z.x * z.x, 1.0, 1e-12);
    EXPECT_NEAR(x.y * x.y + y.y * y.y + z.y * z.y, 1.0, 1e-12);
    EXPECT_NEAR(x.x * x.y + y.x * y.y + z.x * z.y, 0.0, 1e-12);
  }
}

TEST(SolidScene, TheNearerHalfFacesTheReader) {
  EXPECT_TRUE(seen({0.0, 20.0}, -90.0, 1.0, 0.0).faces);
  EXPECT_FALSE(seen({0.0, 20.0}, 90.0, 1.0, 0.0).faces);
  // From above, what is nearer stands lower.
  EXPECT_GT(seen({0.0, 20.0}, -90.0, 1.0, 0.0).y, seen({0.0, 20.0}, 90.0, 1.0, 0.0).y);
}

}  // namespace
}  // namespace rondure::reports
