// Scans, hidden errors and temperatures through whole runs.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/units.h"
#include "plans/run/runner.h"
#include "random_inspection.h"
#include "record/journal/journal.h"
#include "tests/core/scratch.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

namespace fs = std::filesystem;
using testing::journal_of;
using testing::options_for;

/// A perfect cylinder that stands straight: radius 25 mm.
Plan perfect_plan(const std::string& method) {
  Plan plan = test::random_plan(1, "guided", 0.0);
  plan.simulation->part = {};
  plan.part.location_uncertainty_mm = 2.0;
  plan.features.front().sampling.method =
      record::value_named<record::SamplingMethod>(method).value();
  return plan;
}

double zone_mm(const test::Inspection& run) {
  return run.evaluation.features.front().mz_cylinder->width_mm();
}

double radius_mm(const test::Inspection& run) {
  const evaluation::FeatureResult& feature = run.evaluation.features.front();
  return feature.ls_cylinder->radius_mm - feature.tip_radius_mm.value();
}

TEST(Scanning, WithoutErrorsAPerfectCylinderHasNoForm) {
  for (const char* method : {"touch", "scan"}) {
    SCOPED_TRACE(method);
    Plan plan = perfect_plan(method);
    plan.simulation->part.tilt_deg = 2.8;  // its ends are off by 1.95 of the 2 mm allowed
    plan.features.front().sampling.points_per_layer = 36;
    EXPECT_LT(zone_mm(test::inspect(plan)), 1e-9);
  }
}

TEST(Scanning, GivesTheCloudThatTouchesGive) {
  Plan plan = test::random_plan(4, "guided", 0.05);
  plan.features.front().sampling.points_per_layer = 48;
  plan.features.front().sampling.stagger = 0.0;
  plan.features.front().pose_search.max_poses = 1;
  const auto touched = test::inspect(plan);
  plan.features.front().sampling.method = record::SamplingMethod::kScan;
  const auto scanned = test::inspect(plan);
  const auto& a = touched.evaluation.features.front().cloud;
  const auto& b = scanned.evaluation.features.front().cloud;
  ASSERT_EQ(a.size(), 4U * 48U);
  ASSERT_EQ(b.size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_LT((a[i].tip_mm - b[i].tip_mm).norm(), 1e-7) << i;
    ASSERT_EQ(a[i].layer, b[i].layer);
    ASSERT_EQ(a[i].point, b[i].point);
  }
  const auto& truth = scanned.evaluation.features.front().characteristics.front().truths_mm;
  ASSERT_EQ(truth.size(), 1U);
  EXPECT_NEAR(truth.front(), zone_mm(scanned), 2e-10);
  EXPECT_NE(scanned.evaluation.features.front()
                .characteristics.front()
                .value->operator_text()
                .english()
                .find("4 x 48 points, scanned"),
            std::string::npos);
}

TEST(Scanning, ALobeThatFewTouchesMissIsSeen) {
  Plan plan = perfect_plan("touch");
  plan.simulation->part.lobes = {{14, 2.0, 90.0, 0.0}};  // seven touches meet it at its zeros
  plan.features.front().sampling.stagger = 0.0;
  const double touched_mm = zone_mm(test::inspect(plan));
  plan.features.front().sampling.method = record::SamplingMethod::kScan;
  plan.features.front().sampling.points_per_layer = 360;
  EXPECT_LT(touched_mm, 0.1e-3);
  const auto scanned = test::inspect(plan);
  EXPECT_NEAR(zone_mm(scanned), 4e-3, 0.1e-3);
  for (const evaluation::LayerResult& layer : scanned.evaluation.features.front().layers) {
    ASSERT_TRUE(layer.filtered) << "360 points carry a filter of 50 UPR";
    EXPECT_NEAR(layer.filtered->harmonics.harmonics.at(13).amplitude_mm, 2e-3, 0.05e-3);
    // The Gaussian filter passes 2^-(14/50)^2 of it.
    EXPECT_NEAR(layer.filtered->values.front().total_mm, 4e-3 * std::exp2(-0.28 * 0.28), 0.1e-3);
  }
}

TEST(Scanning, AMaskIsHeldAgainstTheTruthOfItsHarmonic) {
  Plan plan = perfect_plan("scan");
  plan.simulation->part.lobes = {{14, 2.0, 90.0, 0.0}};
  plan.simulation->probe.repeatability_um = 0.3;
  plan.features.front().sampling.points_per_layer = 360;
  record::CharacteristicTask asked;
  asked.id = "mask";
  asked.form = record::Form::kHarmonicLimits;
  asked.harmonic_limits = {{10, 20, 3.0}};
  plan.features.front().characteristics = {asked};
  const auto scanned = test::inspect(plan);
  const auto& found = scanned.evaluation.features.front().characteristics.front();
  ASSERT_EQ(found.truths_mm.size(), 1U) << found.reason;
  EXPECT_NEAR(found.truths_mm.front(), 2e-3, 1e-6);
  EXPECT_NE(found.truths_mm.front(), found.value_mm());
}

TEST(Scanning, TypicalErrorsShowAsSomeMicrometres) {
  Plan plan = perfect_plan("scan");
  plan.features.front().sampling.points_per_layer = 72;
  plan.simulation->machine.errors = SimulatedMachinePlan::Errors::kTypical;
  const double zone = zone_mm(test::inspect(plan));
  EXPECT_GT(zone, 0.5e-3);
  EXPECT_LT(zone, 5e-3);
}

TEST(Scanning, AGivenErrorTakesThePlaceOfTheTypicalOne) {
  Plan plan = perfect_plan("scan");
  plan.features.front().sampling.points_per_layer = 72;
  plan.simulation->machine.squareness_xy_urad = 100.0;
  EXPECT_NEAR(zone_mm(test::inspect(plan)), 27.0 * 100e-6, 1e-6);
}

TEST(Scanning, KeywayAndBurrAreSeen) {
  Plan plan = perfect_plan("scan");
  plan.features.front().sampling.points_per_layer = 180;
  plan.simulation->part.burrs = {{90.0, -35.0, 2.0, 2.0, 30.0}};
  const auto burr = test::inspect(plan);
  EXPECT_NEAR(zone_mm(burr), 0.03, 1e-3);
  // From the least-squares axis: the minimum zone moves over until the far side is as high.
  const auto& cloud = burr.evaluation.features.front().cloud;
  const fit::Axis axis = burr.evaluation.features.front().ls_cylinder->axis;
  const auto height_mm = [&](const auto& point) {
    return (point.tip_mm - axis.point_mm).cross(axis.direction).norm();
  };
  const auto highest =
      std::max_element(cloud.begin(), cloud.end(),
                       [&](const auto& x, const auto& y) { return height_mm(x) < height_mm(y); });
  EXPECT_NEAR(highest->angle_rad, M_PI / 2, 0.03);
  EXPECT_EQ(highest->layer, 0);
  plan.simulation->part.burrs.clear();
  plan.simulation->part.keyways = {{180.0, 0.0, 8.0, 200.0, 0.3}};
  EXPECT_NEAR(zone_mm(test::inspect(plan)), 0.3, 0.01);
}

TEST(Scanning, AKeywayDeeperThanTheSearchIsNamedWithItsWindow) {
  Plan plan = perfect_plan("scan");
  plan.machine->search_mm = 3.0;
  FeaturePlan& feature = plan.features.front();
  feature.sampling.points_per_layer = 180;
  feature.sampling.start_deg = 0.0;  // the touches that locate are at multiples of 60 deg
  plan.simulation->part.keyways = {{90.0, 0.0, 8.0, 200.0, 8.0}};
  record::WindowTask slot;
  slot.name = "slot";
  slot.from_deg = 80.0;
  slot.to_deg = 100.0;
  feature.exclude = {slot};
  const test::Scratch root;
  const auto run = run_plan(plan, options_for(root / "run"));
  ASSERT_TRUE(run && run->failure);
  const std::string& what = run->failure->what;
  EXPECT_EQ(run->failure->code, core::Code::kNoTouch) << what;
  EXPECT_NE(what.find("the window slot crosses this layer"), std::string::npos) << what;
  EXPECT_NE(what.find("machine.search_mm (3 mm)"), std::string::npos) << what;
}

TEST(Temperature, SizesAreBroughtToTwentyDegrees) {
  Plan plan = perfect_plan("touch");
  plan.environment.emplace().max_degC = 25.0;
  plan.simulation->temperature_degC = 23.0;
  plan.simulation->part.expansion_per_K = 12e-6;
  plan.simulation->machine.scale_expansion_per_K = 8e-6;
  plan.simulation->machine.scale_temperature_degC = 22.0;
  const auto raw = test::inspect(plan);
  EXPECT_NEAR(radius_mm(raw), 25.0 * (1.0 + 36e-6) - 12.5 * 16e-6, 1e-6)
      << "the scales are short by 16e-6, of which the sphere of 12.5 mm takes its share away";
  EXPECT_FALSE(raw.evaluation.features.front().thermal);
  plan.part.expansion_per_K = 12e-6;
  plan.machine->scale_expansion_per_K = 8e-6;
  const auto at_20 = test::inspect(plan);
  // The reference sphere stands warm in the room, but is taken as at 20 degC, as it is simulated.
  EXPECT_NEAR(radius_mm(at_20), 25.0, 1e-8);
  const auto& thermal = at_20.evaluation.features.front().thermal;
  ASSERT_TRUE(thermal);
  EXPECT_NEAR(thermal->factor, (1.0 + 16e-6) / (1.0 + 36e-6), 1e-12);
  const double u = std::hypot(std::hypot(12e-6 * 0.1, 3.0 * 1e-6), std::hypot(8e-6 * 0.1, 2e-6));
  EXPECT_NEAR(thermal->factor_uncertainty, u, 1e-12);
  ASSERT_EQ(at_20.record.touches.size(), raw.record.touches.size());
  EXPECT_EQ(at_20.record.touches.back().tip_mm, raw.record.touches.back().tip_mm)
      << "the journal keeps what was read";
  EXPECT_EQ(at_20.record.touches.back().scale_temperature_degC, 22.0);
}

TEST(Scanning, AnInterruptedRunGoesOnWithTheSameBits) {
  const auto plan = read_plan(testing::example("08_shaft_scanned.json"));
  ASSERT_TRUE(plan) << testing::lines_of(plan);
  const test::Scratch root;
  int all = 0;  // steps: a touch or a whole circle each
  RunOptions counted = options_for(root / "whole");
  counted.stop_requested = [&all] { return ++all < 0; };
  const auto run = run_plan(*plan, counted);
  ASSERT_TRUE(run && !run->failure);
  const auto whole = journal_of(root / "whole");
  ASSERT_EQ(whole.touches.size(), 13U + 6U + 4U * 360U);
  ASSERT_EQ(all, 13 + 6 + 4);
  for (int steps = 17; steps < all; ++steps) {  // two last touches that locate, then circles
    SCOPED_TRACE(steps);
    const fs::path directory = root / std::to_string(steps);
    RunOptions options = options_for(directory);
    options.stop_requested = [left = steps]() mutable { return left-- == 0; };
    {
      const auto stopped = run_plan(*plan, options);
      ASSERT_TRUE(stopped && stopped->failure);
      ASSERT_EQ(stopped->failure->code, core::Code::kStopped) << stopped->failure->what;
    }  // the journal is free again
    const auto resumed = resume_plan(*plan, options_for(directory));
    ASSERT_TRUE(resumed) << resumed.error().front().what;
    ASSERT_FALSE(resumed->failure) << resumed->failure->what;
    const auto record = journal_of(directory);
    ASSERT_EQ(record.touches.size(), whole.touches.size());
    for (std::size_t i = 0; i < whole.touches.size(); ++i) {
      ASSERT_EQ(record.touches[i].tip_mm, whole.touches[i].tip_mm) << i;
      ASSERT_EQ(record.touches[i].time_s, whole.touches[i].time_s) << i;
      ASSERT_EQ(record.touches[i].approach, whole.touches[i].approach) << i;
    }
    ASSERT_NE(record.truth_series_of(0, record::kTrueTips), nullptr);
    EXPECT_EQ(record.truth_series_of(0, record::kTrueTips)->values,
              whole.truth_series_of(0, record::kTrueTips)->values);
    EXPECT_FALSE(record.checks.empty());
  }
}

}  // namespace
}  // namespace rondure::plans
