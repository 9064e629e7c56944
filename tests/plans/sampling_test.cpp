#include "plans/path/sampling.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace rondure::plans {
namespace {

using ::testing::HasSubstr;

FeaturePlan four_by_seven() {
  FeaturePlan feature;
  feature.nominal = {50.0, -40.0, 40.0};
  feature.sampling = {4, 7, 5.0, 0.0, 0.0};
  return feature;
}

TEST(SamplingTargets, LieAtTheHeightsAndAnglesOfTheReferenceCase) {
  const auto targets = sampling_targets(four_by_seven());
  ASSERT_TRUE(targets);
  ASSERT_EQ(targets->size(), 28U);
  const double heights[] = {-35.0, -35.0 + 70.0 / 3.0, 35.0 - 70.0 / 3.0, 35.0};
  for (std::size_t i = 0; i < 28; ++i) {
    const Target& target = (*targets)[i];
    EXPECT_EQ(target.layer, static_cast<int>(i) / 7);
    EXPECT_EQ(target.point, static_cast<int>(i) % 7);
    EXPECT_NEAR(target.z_mm, heights[i / 7], 1e-12);
    EXPECT_NEAR(target.theta_rad, core::kTwoPi * static_cast<double>(i % 7) / 7.0, 1e-14);
  }
}

TEST(SamplingTargets, FullStaggerInterleavesTheLayersEvenly) {
  FeaturePlan feature = four_by_seven();
  feature.sampling.stagger = 1.0;
  feature.sampling.start_deg = 10.0;
  const auto targets = sampling_targets(feature);
  ASSERT_TRUE(targets);
  std::vector<double> angles;
  for (const Target& target : *targets) angles.push_back(target.theta_rad - 10.0 * core::kDegree);
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_NEAR(angles[i], core::kTwoPi * static_cast<double>(i) / 28.0, 1e-12);
  }
}

TEST(SamplingTargets, ASingleLayerAndACircleLieInTheMiddle) {
  FeaturePlan feature = four_by_seven();
  feature.nominal.to_mm = 60.0;
  feature.sampling.layers = 1;
  EXPECT_EQ(sampling_targets(feature)->front().z_mm, 10.0);
  feature.type = record::Shape::kCircle;
  feature.nominal = {50.0, 12.0, 32.0};
  feature.sampling.layers = 4;
  const auto circle = sampling_targets(feature);
  ASSERT_TRUE(circle);
  EXPECT_EQ(circle->size(), 7U);
  EXPECT_EQ(circle->back().z_mm, 22.0);
}

TEST(SamplingTargets, RefusesWhatCannotBePlaced) {
  FeaturePlan feature = four_by_seven();
  feature.sampling.margin_mm = 40.0;
  auto refused = sampling_targets(feature);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kSampling);
  EXPECT_EQ(refused.error().what,
            "a margin of 40 mm at both ends leaves no room for 4 layers on 80 mm");
  feature = four_by_seven();
  feature.sampling.layers = 0;
  EXPECT_EQ(sampling_targets(feature).error().code, core::Code::kSampling);
  feature = four_by_seven();
  feature.sampling.points_per_layer = 2;
  EXPECT_THAT(sampling_targets(feature).error().what, HasSubstr("at least 3"));
}

TEST(QualificationDirections, StartAtThePoleEndOnTheEquatorAndKeepApart) {
  for (int points = 5; points <= 100; ++points) {
    SCOPED_TRACE(points);
    const auto directions = qualification_directions(points);
    ASSERT_TRUE(directions);
    ASSERT_EQ(directions->size(), static_cast<std::size_t>(points));
    EXPECT_EQ(directions->front(), Eigen::Vector3d::UnitZ());
    EXPECT_EQ(directions->back().z(), 0.0);
    const double even_rad = std::sqrt(core::kTwoPi / points);  // side of a square of even share
    double nearest_rad = 4.0;
    for (std::size_t i = 0; i < directions->size(); ++i) {
      EXPECT_NEAR((*directions)[i].norm(), 1.0, 1e-15);
      if (i > 0) {
        EXPECT_LE((*directions)[i].z(), (*directions)[i - 1].z() + 1e-15);
      }
      for (std::size_t j = 0; j < i; ++j) {
        nearest_rad = std::min(nearest_rad, std::acos((*directions)[i].dot((*directions)[j])));
      }
    }
    EXPECT_GT(nearest_rad, 0.5 * even_rad);
    const auto on_equator = std::count_if(directions->begin(), directions->end(),
                                          [](const auto& d) { return d.z() == 0.0; });
    EXPECT_GE(on_equator, 4);
  }
}

TEST(QualificationDirections, LeaveNoLargeHole) {
  for (const int points : {9, 13, 25, 50, 100}) {
    SCOPED_TRACE(points);
    const auto directions = qualification_directions(points);
    double hole_rad = 0.0;
    for (int i = 0; i <= 30; ++i) {
      for (int j = 0; j < 120; ++j) {
        const double elevation = i * 3.0 * core::kDegree;
        const double theta = j * 3.0 * core::kDegree;
        const Eigen::Vector3d d(std::cos(elevation) * std::cos(theta),
                                std::cos(elevation) * std::sin(theta), std::sin(elevation));
        double nearest = -1.0;
        for (const auto& direction : *directions) nearest = std::max(nearest, direction.dot(d));
        hole_rad = std::max(hole_rad, std::acos(std::min(1.0, nearest)));
      }
    }
    EXPECT_LT(hole_rad, std::sqrt(core::kTwoPi / points));
  }
}

TEST(QualificationDirections, RefuseNumbersOutsideTheirRange) {
  for (const int points : {4, 101, -1}) {
    const auto refused = qualification_directions(points);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kSampling);
    EXPECT_THAT(refused.error().what, HasSubstr("5..100"));
  }
}

}  // namespace
}  // namespace rondure::plans
