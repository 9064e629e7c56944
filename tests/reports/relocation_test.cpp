// A part that was located again while its final cloud was repeated: two placements in one run.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/feature_values.h"
#include "web/internal/sections.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using record::Touch;

constexpr double kRadius_mm = 25.0;
constexpr int kPoints = 16;

/// The touches of one pose: `layers` rings of a cylinder without form error.
void add_rings(record::RunRecord& run, int pose, Touch::Purpose purpose, int layers,
               const Eigen::Isometry3d& X_WP) {
  for (int i = 0; i < layers * kPoints; ++i) {
    const double angle = core::kTwoPi * (i % kPoints) / kPoints;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    Touch touch;
    touch.id = static_cast<std::int64_t>(run.touches.size());
    touch.purpose = purpose;
    touch.pose = pose;
    touch.layer = i / kPoints;
    touch.point = i % kPoints;
    touch.tip_mm = X_WP * (kRadius_mm * out + 20.0 * touch.layer * Eigen::Vector3d::UnitZ());
    touch.approach = -(X_WP.linear() * out);
    touch.temperature_degC = 20.0;
    run.touches.push_back(touch);
  }
}

/// Located and measured upright, then again with the axis 1 degree off.
record::RunRecord relocated_run(record::Shape shape) {
  record::RunRecord run;
  run.ending = "finished";
  record::Feature feature;
  feature.id = "seat";
  feature.shape = shape;
  feature.nominal_diameter_mm = 2.0 * kRadius_mm;
  feature.layers = shape == record::Shape::kCircle ? 1 : 3;
  feature.points_per_layer = kPoints;
  run.features = {feature};
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
  for (int pose = 0; pose < 4; ++pose) {
    const bool measures = pose % 2 == 1;
    if (pose == 2) X_WP.rotate(Eigen::AngleAxisd(core::kDegree, Eigen::Vector3d::UnitX()));
    run.poses.push_back({pose, 0, {}, {}, measures, 10.0 * pose});
    add_rings(run, pose, measures ? Touch::Purpose::kMeasure : Touch::Purpose::kLocate,
              measures ? feature.layers : 3, X_WP);
  }
  return run;
}

TEST(Relocation, ACircleLiesAcrossTheAxisOfItsOwnPlacement) {
  const record::RunRecord run = relocated_run(record::Shape::kCircle);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const evaluation::FeatureResult& circle = evaluation->features[0];
  ASSERT_FALSE(circle.failure) << circle.failure->what;
  // Seen along the first placement it is an ellipse, 25 mm * (1 - cos 1 deg) = 3.8 um out of round.
  EXPECT_LT(circle.layers[0].mz->width_mm(), 1e-9);
  const auto live = web::evaluate_so_far(run, run.poses.back());
  ASSERT_TRUE(live) << live.error().what;
  EXPECT_LT(live->result.layers[0].mz->width_mm(), 1e-9);
  const auto first = web::evaluate_so_far(run, run.poses[1]);
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_LT(first->result.layers[0].mz->width_mm(), 1e-9) << "of the first placement as well";
}

TEST(Relocation, OneFinalPoseIsToldTheOneThatIsEvaluated) {
  const record::RunRecord run = relocated_run(record::Shape::kCylinder);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const evaluation::FeatureResult& cylinder = evaluation->features[0];
  ASSERT_FALSE(cylinder.failure) << cylinder.failure->what;
  ASSERT_EQ(cylinder.poses.size(), 2U);
  EXPECT_FALSE(cylinder.poses[0].final_pose);
  EXPECT_EQ(final_pose_of(cylinder), &cylinder.poses[1]);
  // f of the tilted cloud: 40 mm along an axis 1 degree off; the first stood upright.
  EXPECT_LT(cylinder.poses[0].f_mm, 1e-6);
  EXPECT_GT(cylinder.poses[1].f_mm, 0.3);
  const auto tilt = [](const core::Error& warning) {
    return warning.code == core::Code::kNotLevel;
  };
  EXPECT_EQ(std::count_if(cylinder.warnings.begin(), cylinder.warnings.end(), tilt), 1);
}

}  // namespace
}  // namespace rondure::reports
