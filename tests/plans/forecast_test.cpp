// What is foretold is what a run does: the simulated machine is followed move by move.

#include "plans/forecast/forecast.h"

#include <cstdio>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "fit/least_squares/cylinder.h"
#include "plans/forecast/picture.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::plan_of;

/// The plan in a world without errors.
Plan ideal(Plan plan) {
  plan.simulation->part = {};
  plan.simulation->probe = {};
  plan.simulation->machine = {};
  plan.simulation->temperature_degC = 20.0;
  plan.simulation->fixture = {};
  return plan;
}

/// What the machine was told during a run.
struct Followed {
  std::vector<Vector3d> moves;
  std::vector<Vector3d> contacts;
  double behind_last_touch_mm = 0.0;
  record::RunRecord record;
};

Followed follow(const Plan& plan) {
  Followed out;
  const record::Scratch scratch;
  RunOptions options;
  options.directory = scratch / "run";
  options.run_id = "run";
  options.before_move = [&out](const NextMove& move) -> core::Result<void> {
    if (move.kind == NextMove::Kind::kMove) {
      out.moves.push_back(move.to_W_mm);
      out.behind_last_touch_mm += (move.to_W_mm - move.from_W_mm).norm();
    } else if (move.kind == NextMove::Kind::kTouch) {
      out.contacts.push_back(move.to_W_mm);
      out.behind_last_touch_mm = 0.0;
    }
    return {};
  };
  const auto run = run_plan(plan, options);
  EXPECT_TRUE(run && !run->failure) << (run && run->failure ? run->failure->what : "");
  if (run) out.record = record::read_journal(scratch / "run")->record;
  return out;
}

/// Corners of all stages with their repeats, without moves that go nowhere.
Followed foretold(const Plan& plan, const Forecast& forecast) {
  Followed out;
  Vector3d tip(plan.machine->park_mm[0], plan.machine->park_mm[1], plan.machine->park_mm[2]);
  for (const ForecastStage& stage : forecast.stages) {
    for (int i = 0; i < stage.times; ++i) {
      for (const Vector3d& corner : stage.moves_W) {
        if ((corner - tip).norm() > 1e-6) out.moves.push_back(corner);
        tip = corner;
      }
      out.contacts.insert(out.contacts.end(), stage.contacts_W.begin(), stage.contacts_W.end());
    }
  }
  return out;
}

void expect_same_places(const std::vector<Vector3d>& done, const std::vector<Vector3d>& foretold) {
  ASSERT_EQ(done.size(), foretold.size());
  for (std::size_t i = 0; i < done.size(); ++i) {
    ASSERT_LT((done[i] - foretold[i]).norm(), 1e-8) << "move " << i;
  }
}

/// The machine's clock when the run was over.
double clock_at_end(const Plan& plan, const Followed& run) {
  const FeaturePlan& last = plan.features.back();
  double rest_s = 0.0;  // a scan goes on from its last point to where it began
  if (last.sampling.method == record::SamplingMethod::kScan) {
    const double radius_mm = 0.5 * (last.nominal.diameter_mm + plan.probe->tip_diameter_mm);
    rest_s =
        core::kTwoPi * radius_mm / last.sampling.points_per_layer / plan.machine->scan_speed_mm_s;
  }
  return run.record.touches.back().time_s + rest_s +
         (plan.machine->approach_mm + run.behind_last_touch_mm) / plan.machine->travel_speed_mm_s +
         0.2;
}

class ForecastOf : public ::testing::TestWithParam<const char*> {};

TEST_P(ForecastOf, IsThePathAndTheTimeOfARunInAnIdealWorld) {
  const Plan plan = ideal(plan_of(GetParam()));
  const auto forecast = plans::forecast(plan);
  ASSERT_TRUE(forecast) << forecast.error().what;
  const Followed run = follow(plan);
  const Followed told = foretold(plan, *forecast);
  expect_same_places(run.contacts, told.contacts);
  expect_same_places(run.moves, told.moves);
  EXPECT_EQ(run.record.touches.size(), static_cast<std::size_t>(forecast->touches));
  EXPECT_EQ(run.record.poses.size(), static_cast<std::size_t>(forecast->poses));
  EXPECT_NEAR(clock_at_end(plan, run) / forecast->time_s, 1.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Strategies, ForecastOf,
                         ::testing::Values("01_spool_simulated.json", "08_shaft_scanned.json",
                                           "14_bore_simulated.json",
                                           "11_pose_search_as_published.json",
                                           "13_pose_search_virtual.json"));

/// The plan in a fixture that a hand sets: three spheres on the ring show each pose.
Plan by_hand(Plan plan) {
  plan.fixture->driver = FixturePlan::Driver::kManual;
  plan.fixture->reached_pose.emplace().spheres = {
      {{70.0, 0.0, -40.0}}, {{-35.0, 60.0, -40.0}}, {{-35.0, -60.0, -40.0}}};
  return plan;
}

TEST(Forecast, TellsTheSpheresOnTheRingOfAFixtureThatAHandSets) {
  for (const char* example : {"01_spool_simulated.json", "11_pose_search_as_published.json"}) {
    SCOPED_TRACE(example);
    const Plan plan = by_hand(ideal(plan_of(example)));
    const auto forecast = plans::forecast(plan);
    ASSERT_TRUE(forecast) << forecast.error().what;
    const Followed run = follow(plan);
    EXPECT_EQ(static_cast<std::size_t>(forecast->touches), run.record.touches.size());
    EXPECT_EQ(static_cast<std::size_t>(forecast->poses), run.record.poses.size());
    EXPECT_NEAR(clock_at_end(plan, run) / forecast->time_s, 1.0, 1e-4);
  }
}

TEST(Forecast, RefusesAPoseWhoseSpheresOnTheRingCannotBeReached) {
  Plan plan = by_hand(ideal(plan_of("01_spool_simulated.json")));
  plan.fixture->reached_pose->spheres[0].center_mm = {20.0, 0.0, -40.0};  // inside the part
  const auto forecast = plans::forecast(plan);
  ASSERT_FALSE(forecast);
  EXPECT_EQ(forecast.error().code, core::Code::kUnreachable);
  EXPECT_THAT(forecast.error().what, HasSubstr("to a sphere on the ring"));
}

TEST(Forecast, TellsTheTimeOfARunOnARealPartWithinTwoPercent) {
  for (const char* example : {"13_pose_search_virtual.json", "08_shaft_scanned.json"}) {
    SCOPED_TRACE(example);
    const Plan plan = plan_of(example);
    const auto forecast = plans::forecast(plan);
    ASSERT_TRUE(forecast) << forecast.error().what;
    const Followed run = follow(plan);
    EXPECT_NEAR(clock_at_end(plan, run) / forecast->time_s, 1.0, 0.02);
  }
}

TEST(Forecast, HasAStageForEachCloudAndMarksTheFinalOne) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const auto forecast = plans::forecast(plan);
  ASSERT_TRUE(forecast);
  using Kind = ForecastStage::Kind;
  ASSERT_EQ(forecast->stages.size(), 3U);
  EXPECT_EQ(forecast->stages[0].kind, Kind::kQualification);
  EXPECT_EQ(forecast->stages[1].kind, Kind::kLocation);
  EXPECT_EQ(forecast->stages[1].touches, 6);
  EXPECT_EQ(forecast->stages[2].kind, Kind::kCloud);
  EXPECT_TRUE(forecast->stages[2].final_cloud);
  EXPECT_EQ(forecast->stages[2].times, 5);
  EXPECT_EQ(forecast->touches, 13 + 6 + 5 * 28);
}

TEST(Forecast, OfPointsFromAFileIsEmpty) {
  const auto forecast = plans::forecast(plan_of("09_axle_points_file.json"));
  ASSERT_TRUE(forecast);
  EXPECT_TRUE(forecast->stages.empty());
  EXPECT_EQ(forecast->time_s, 0.0);
}

TEST(Forecast, DrawsEveryTouchTwiceAndTheScale) {
  Plan plan = plan_of("01_spool_simulated.json");
  plan.features.front().id = "<a & b>";
  const auto forecast = plans::forecast(plan);
  ASSERT_TRUE(forecast);
  const std::string svg = forecast_picture(plan, forecast->stages.back());
  std::size_t circles = 0;
  std::istringstream lines(svg);
  double left = 0.0, top = 0.0, side = 0.0, x = 0.0, y = 0.0;
  for (std::string line; std::getline(lines, line);) {
    std::sscanf(line.c_str(), "<svg x=\"%lf\" y=\"%lf\" width=\"%lf\"", &left, &top, &side);
    if (std::sscanf(line.c_str(), "<circle cx=\"%lf\" cy=\"%lf\"", &x, &y) != 2) continue;
    ++circles;
    EXPECT_TRUE(x > left && x < left + side && y > top && y < top + side) << "beside its panel";
  }
  EXPECT_EQ(circles, 2U * 28U);
  EXPECT_THAT(svg, HasSubstr(" mm</text>"));
  EXPECT_THAT(svg, HasSubstr("&lt;a &amp; b>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Location, SixTouchesFindATiltedAndShiftedPart) {
  for (int k = 0; k < 4; ++k) {
    SCOPED_TRACE(k);
    Plan plan = ideal(plan_of("01_spool_simulated.json"));
    plan.part.location_uncertainty_mm = 6.0;
    plan.features.front().pose_search.repeats = 1;
    SimulatedPartPlan& part = plan.simulation->part;
    part.tilt_deg = 1.5 * k;
    part.tilt_toward_deg = 70.0 * k;
    part.offset_x_mm = 0.3 * k;
    part.offset_y_mm = -0.4;
    const Followed run = follow(plan);
    std::vector<Vector3d> tips;
    for (const record::Touch& touch : run.record.touches) {
      if (touch.purpose == record::Touch::Purpose::kLocate) tips.push_back(touch.tip_mm);
    }
    ASSERT_EQ(tips.size(), 6U);
    const auto found = fit::ls_cylinder(tips, Vector3d::UnitZ());
    ASSERT_TRUE(found);
    const double toward = part.tilt_toward_deg * core::kDegree;
    const double tilt = part.tilt_deg * core::kDegree;
    const Vector3d axis(std::sin(tilt) * std::cos(toward), std::sin(tilt) * std::sin(toward),
                        std::cos(tilt));
    EXPECT_LT((found->axis.direction - axis).norm(), 1e-9);
    EXPECT_NEAR(found->radius_mm, 27.0, 1e-9);
    EXPECT_LT(found->deviation_mm, 1e-9) << "the sixth touch checks the other five";
  }
}

TEST(SingleSteps, EndInOrderWhereverTheOperatorRefusesAndGoOn) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const auto run_to = [&](const std::filesystem::path& directory, int moves) {
    RunOptions options;
    options.directory = directory;
    options.run_id = "run";
    options.started_utc = "2026-11-21T02:33:02Z";
    options.before_move = [left = moves](const NextMove&) mutable -> core::Result<void> {
      if (left-- > 0) return {};
      return core::fail(core::Code::kStopped, "no");
    };
    return run_plan(plan, options);
  };
  const record::Scratch whole_scratch;
  std::string whole;
  {
    const auto run = run_to(whole_scratch / "run", 1'000'000);
    ASSERT_TRUE(run && !run->failure);
    whole = record::measured_bits(record::read_journal(whole_scratch / "run")->record);
  }
  for (const int moves : {0, 1, 3, 7, 40, 120, 133, 200, 333, 601}) {
    SCOPED_TRACE(moves);
    const record::Scratch scratch;
    {
      const auto run = run_to(scratch / "run", moves);
      ASSERT_TRUE(run && run->failure);
      ASSERT_EQ(run->failure->code, core::Code::kStopped) << run->failure->what;
    }
    RunOptions options;
    options.directory = scratch / "run";
    options.run_id = "run";
    options.started_utc = "2026-11-21T02:33:02Z";
    const auto run = resume_plan(plan, options);
    ASSERT_TRUE(run && !run->failure);
    EXPECT_EQ(record::measured_bits(record::read_journal(scratch / "run")->record), whole);
  }
}

}  // namespace
}  // namespace rondure::plans
