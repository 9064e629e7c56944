#include "plans/run/internal/reached_pose.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fixture/simulated.h"
#include "plans/forecast/forecast.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/runner.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::options_for;

/// The spool in a fixture that a simulated hand sets to 0.15 deg; the machine is perfect.
Plan plan_by_hand() {
  auto plan = read_plan(testing::example("01_spool_simulated.json"));
  if (!plan) throw std::runtime_error(testing::lines_of(plan));  // fails the test
  plan->simulation->probe = {};
  plan->simulation->fixture = {};
  plan->simulation->fixture.repeatability_deg = 0.15;
  plan->simulation->fixture.base_offset_mm = {0.3, -0.2, 0.1};
  plan->simulation->fixture.base_rotation_deg = {0.1, -0.1, 0.2};
  plan->fixture->datum.emplace();
  plan->fixture->datum->spheres = {
      {{-200.0, -150.0, 60.0}}, {{-200.0, 150.0, 60.0}}, {{200.0, -150.0, 60.0}}};
  plan->fixture->datum->uncertainty_mm = 3.0;
  plan->fixture->driver = FixturePlan::Driver::kManual;
  plan->fixture->resolution_deg = 0.5;
  plan->fixture->reached_pose.emplace();
  plan->fixture->reached_pose->spheres = {
      {{70.0, 0.0, -40.0}}, {{-35.0, 60.0, -40.0}}, {{-35.0, -60.0, -40.0}}};
  plan->fixture->reached_pose->setting_uncertainty_deg = 1.0;
  plan->features.front().pose_search.repeats = 1;
  return std::move(*plan);
}

record::RunRecord record_of(const std::filesystem::path& directory) {
  return record::read_journal(directory)->record;
}

/// Where the simulated hand really turned the ring, pose by pose: the same noise once more.
std::vector<Eigen::Matrix3d> true_turns(const Plan& plan, const record::RunRecord& record) {
  fixture::SimulatedFixtureOptions options;
  options.limits = limits_of(*plan.fixture);
  options.errors.repeatability_rad = plan.simulation->fixture.repeatability_deg * kDegree;
  options.seed = plan.simulation->seed;
  fixture::SimulatedFixture fixture(options);
  EXPECT_TRUE(fixture.home());
  std::vector<Eigen::Matrix3d> out;
  for (const record::PoseVisit& pose : record.poses) {
    EXPECT_TRUE(fixture.move_to(on_grid(pose.commanded)));
    out.push_back(fixture.true_body_to_machine().linear());
  }
  return out;
}

TEST(ReachedPose, IsWhatTheHandReallySetNotWhatItWasAskedFor) {
  const Plan plan = plan_by_hand();
  const record::Scratch scratch;
  const auto run = run_plan(plan, options_for(scratch / "run"));
  ASSERT_TRUE(run) << run.error().what;
  ASSERT_FALSE(run->failure) << run->failure->what;
  const record::RunRecord record = record_of(scratch / "run");
  ASSERT_GE(record.poses.size(), 2U);
  const auto truth = true_turns(plan, record);
  double farthest_deg = 0.0;
  for (std::size_t i = 0; i < record.poses.size(); ++i) {
    SCOPED_TRACE(i);
    const record::PoseVisit& pose = record.poses[i];
    const Eigen::Matrix3d measured = fixture::body_to_machine({}, pose.reached).linear();
    EXPECT_LT((measured - truth[i]).norm(), 1e-7);
    farthest_deg = std::max(farthest_deg,
                            std::abs(pose.reached.alpha_rad - pose.commanded.alpha_rad) / kDegree);
  }
  EXPECT_GT(farthest_deg, 0.02);
}

TEST(ReachedPose, OfAnInterruptedRunIsTheSameToTheLastBit) {
  Plan plan = plan_by_hand();
  const record::Scratch scratch;
  ASSERT_FALSE(run_plan(plan, options_for(scratch / "whole"))->failure);
  const record::RunRecord whole = record_of(scratch / "whole");
  // 13 touches of the probe, 21 of the base; 21 on the ring of the first pose, then its cloud.
  for (const int touch : {36, 54, 56, 60, 90, 101, 110}) {
    SCOPED_TRACE(touch);
    plan.simulation->faults.connection_lost_at_touch = touch;
    const auto directory = scratch / ("cut" + std::to_string(touch));
    {
      const auto cut = run_plan(plan, options_for(directory));  // holds the journal while it lives
      ASSERT_TRUE(cut && cut->failure);
    }
    const auto on = resume_plan(plan, options_for(directory));
    ASSERT_TRUE(on) << on.error().front().what;
    ASSERT_FALSE(on->failure) << on->failure->what;
    const record::RunRecord resumed = record_of(directory);
    ASSERT_EQ(resumed.poses.size(), whole.poses.size());
    for (std::size_t i = 0; i < whole.poses.size(); ++i) {
      EXPECT_EQ(resumed.poses[i].reached, whole.poses[i].reached);
    }
    std::size_t k = 0;
    for (const record::Touch& t : resumed.touches) {
      if (t.purpose == record::Touch::Purpose::kCheck) continue;
      ASSERT_LT(k, whole.touches.size());
      ASSERT_EQ(t.tip_mm, whole.touches[k].tip_mm) << t.id;
      ++k;
    }
    EXPECT_EQ(k, whole.touches.size());
  }
}

TEST(ReachedPose, RefusesAPoseThatWasSetTooFarOff) {
  Plan plan = plan_by_hand();
  plan.simulation->fixture.repeatability_deg = 0.4;
  plan.fixture->reached_pose->setting_uncertainty_deg = 0.1;
  const record::Scratch scratch;
  const auto run = run_plan(plan, options_for(scratch / "run"));
  ASSERT_TRUE(run && run->failure);
  EXPECT_EQ(run->failure->code, core::Code::kMachine);
  EXPECT_THAT(run->failure->what, HasSubstr("set it anew, then resume"));
  EXPECT_TRUE(is_resumable(*run->failure));
}

/// Tip centres on spheres of 12 mm about these centres, turned to a pose.
std::vector<std::vector<Vector3d>> tips_about(const std::vector<Vector3d>& centers_B,
                                              const core::Pose& pose) {
  const Eigen::Isometry3d X_WB = fixture::body_to_machine({}, pose);
  std::vector<std::vector<Vector3d>> out;
  for (const Vector3d& center : centers_B) {
    std::vector<Vector3d> tips;
    for (const Vector3d& d : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0),
                              Vector3d(0, -1, 0), Vector3d(0, 0, 1), Vector3d(0.6, 0, 0.8)}) {
      tips.push_back(X_WB * center + 12.0 * d);
    }
    out.push_back(std::move(tips));
  }
  return out;
}

TEST(ReachedPose, IsRefusedWhereTheSpheresDoNotTellIt) {
  Plan plan = plan_by_hand();
  const core::Pose pose = {10.0 * kDegree, 5.0 * kDegree};
  std::vector<Vector3d> centers = {{70, 0, -40}, {-35, 60, -40}, {-35, -60, -40}};
  const auto good = reached_pose(plan, {}, tips_about(centers, pose), pose);
  ASSERT_TRUE(good) << good.error().what;
  EXPECT_NEAR(good->alpha_rad, pose.alpha_rad, 1e-11);
  EXPECT_NEAR(good->beta_rad, pose.beta_rad, 1e-11);
  centers[1].x() += 0.1;  // loose
  const auto loose = reached_pose(plan, {}, tips_about(centers, pose), pose);
  ASSERT_FALSE(loose);
  EXPECT_EQ(loose.error().code, core::Code::kCalibration);
  EXPECT_THAT(loose.error().what, HasSubstr("residual_limit_um"));
  // Of two spheres of one height either axis lifts one and lowers the other.
  for (const double y : {60.0, 0.0}) {
    const Vector3d out(60.0 - y, y, 0.0);
    const Vector3d at(0.0, 0.0, -40.0);
    plan.fixture->reached_pose->spheres = {{{out.x(), out.y(), -40.0}},
                                           {{-out.x(), -out.y(), -40.0}}};
    const auto blind = reached_pose(plan, {}, tips_about({at + out, at - out}, pose), pose);
    ASSERT_FALSE(blind);
    EXPECT_EQ(blind.error().code, core::Code::kRank);
    EXPECT_THAT(blind.error().what, HasSubstr("add a sphere off the line"));
  }
  // Two of different heights tell the pose.
  plan.fixture->reached_pose->spheres = {{{60.0, 50.0, -20.0}}, {{-60.0, -40.0, -60.0}}};
  EXPECT_TRUE(reached_pose(plan, {}, tips_about({{60, 50, -20}, {-60, -40, -60}}, pose), pose));
}

/// The forecast refuses the plan, and with it validate, plan and run.
void expect_refused(const Plan& plan, const std::string& what) {
  const auto planned = forecast(plan);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().code, core::Code::kUnreachable);
  EXPECT_THAT(planned.error().what, HasSubstr(what));
}

TEST(ReachedPose, KeepsTheToolOffTheRing) {
  Plan plan = plan_by_hand();
  plan.fixture->reached_pose->spheres[1].center_mm = {-35.0, 30.0, -40.0};  // above the ring
  expect_refused(plan, "sphere 2 on the ring, point");
}

TEST(ReachedPose, KeepsTheToolOffTheOtherSpheresOfTheFixture) {
  Plan plan = plan_by_hand();
  plan.fixture->reached_pose->spheres[2].center_mm = {-35.0, 85.0, -30.0};
  expect_refused(plan, "to a sphere on the ring");
  plan = plan_by_hand();
  plan.fixture->datum->spheres[0].center_mm = {95.0, 0.0, 110.0};
  expect_refused(plan, "sphere 1 of the fixture, point");
}

// While the spheres were no obstacles, `plan` accepted all 36, and 7 ended in a collision.
TEST(ReachedPose, NoPlanThatIsNotRefusedMeetsASphere) {
  int refused = 0;
  for (int k = 0; k < 36; ++k) {
    SCOPED_TRACE(k);
    Plan plan = plan_by_hand();
    plan.fixture->datum.reset();
    plan.simulation->fixture = {};
    plan.simulation->fixture.repeatability_deg = 0.02;
    plan.fixture->reached_pose->setting_uncertainty_deg = 0.3;
    // Above the part, where the tip comes down to it.
    const double away_mm = std::array{34.0, 45.0, 60.0, 75.0}[static_cast<std::size_t>(k % 4)];
    const double turn_rad = 10.0 * k * kDegree;
    plan.fixture->reached_pose->spheres[0].center_mm = {away_mm * std::cos(turn_rad),
                                                        away_mm * std::sin(turn_rad), 66.0};
    if (!forecast(plan)) {
      ++refused;
      continue;
    }
    const record::Scratch scratch;
    const auto run = run_plan(plan, options_for(scratch / "run"));
    ASSERT_TRUE(run) << run.error().what;
    EXPECT_FALSE(run->failure) << run->failure->what;
  }
  EXPECT_GE(refused, 5);
  EXPECT_LE(refused, 30);
}

TEST(ReachedPose, ParkHeightClearsTheSpheresOfTheFixture) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(
      *record::read_file(testing::example("01_spool_simulated.json")));
  json["fixture"]["driver"] = "manual";
  json["fixture"]["reached_pose"]["spheres"] = {{{"center_mm", {0.0, 0.0, -370.0}}},
                                                {{"center_mm", {-35.0, 60.0, -40.0}}}};
  json["probe"]["qualification"]["sphere_center_mm"] = {900.0, 0.0, 100.0};
  const auto low = parse_plan(json.dump(), {}, "plan");
  ASSERT_FALSE(low);
  EXPECT_THAT(testing::lines_of(low), HasSubstr("park height 500 mm is below"));
}

}  // namespace
}  // namespace rondure::plans
