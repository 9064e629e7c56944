// One plan calibrates the fixture and inspects in it: the same as two plans with a file between,
// wherever it is interrupted; what is void, and what a forged journal gets. Refused plans:
// tests/data/bad_plans. Over the wire: tests/app/ipp_run_test.cpp.

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/handed_calibration.h"
#include "plans/run/runner.h"
#include "tests/plans/files.h"
#include "tests/plans/random_inspection.h"
#include "tests/record/sample_run.h"

namespace rondure::plans::joined {
namespace {

namespace fs = std::filesystem;
using core::MessageCode;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::journal_of;

json example_18() {
  json out = json::parse(testing::bytes_of(testing::example("18_calibrate_and_inspect.json")));
  out["fixture"].erase("bodies");  // one of them is a file beside it
  return out;
}

Plan plan_of(const json& text, const fs::path& folder = {}) {
  auto plan = parse_plan(text.dump(), folder, "plan.json");
  EXPECT_TRUE(plan) << testing::lines_of(plan);
  return std::move(plan).value();  // throws: this test fails, the others continue
}

RunOptions options_for(const fs::path& directory) {
  RunOptions options = testing::options_for(directory);
  options.calibrate = test::calibrated;
  return options;
}

record::RunRecord run_of(const Plan& plan) {
  const record::Scratch scratch;
  {
    const auto run = run_plan(plan, options_for(scratch / "run"));
    EXPECT_TRUE(run) << run.error().what;
    EXPECT_TRUE(run && !run->failure) << (run ? run->failure->what : "");
  }
  return journal_of(scratch / "run");
}

const record::Decision* decided(const record::RunRecord& record, MessageCode code) {
  const auto found = std::find_if(record.decisions.begin(), record.decisions.end(),
                                  [&](const auto& d) { return d.message.code == code; });
  return found == record.decisions.end() ? nullptr : &*found;
}

/// Tip centres of a feature, as touched.
std::vector<Eigen::Vector3d> tips_of(const record::RunRecord& record, int feature) {
  std::vector<Eigen::Vector3d> out;
  for (const record::Touch& touch : record.touches) {
    if (touch.pose < 0) continue;
    if (record.poses[static_cast<std::size_t>(touch.pose)].feature == feature) {
      out.push_back(touch.tip_mm);
    }
  }
  return out;
}

/// The halves of example 18 as plans of their own; the second one reads `calibration`.
Plan first_half(json plan) {
  plan["fixture"].erase("calibration");
  plan["features"].erase(1);
  return plan_of(plan);
}
Plan second_half(json plan, const std::string& calibration, const record::Scratch& scratch) {
  std::ofstream(scratch / "found.json") << calibration;
  plan["fixture"]["calibration"] = {{"file", "found.json"}};
  plan["features"].erase(0);
  return plan_of(plan, scratch.path());
}

TEST(JoinedCalibration, FindsWhatThePlanOfTheBallsAloneFinds) {
  const auto record = run_of(plan_of(example_18()));
  const auto apart = run_of(first_half(example_18()));
  EXPECT_EQ(tips_of(record, 0), tips_of(apart, 0));
  const record::Decision* taken = decided(record, MessageCode::kCalibrationTaken);
  ASSERT_NE(taken, nullptr);
  const auto alone = evaluation::evaluate(apart);
  EXPECT_EQ(taken->message.text(0), evaluation::handed_calibration(alone->features.at(0)).text);
  EXPECT_EQ(taken->message.text(1), "");
  const auto result = evaluation::evaluate(record);
  EXPECT_EQ(evaluation::handed_calibration(result->features.at(0)).text, taken->message.text(0));
  ASSERT_TRUE(result->fixture);
  EXPECT_FALSE(result->fixture->invalid);
  EXPECT_EQ(result->verdict, evaluation::Verdict::kConforms);
}

TEST(JoinedCalibration, InspectsAsThePlanWithTheFileDoes) {
  json quiet = example_18();  // the number of a touch is that of its noise
  quiet["simulation"]["probe"]["repeatability_um"] = 0;
  quiet["features"][0]["rotary_axes"]["uncertainty"] = {{"ball_um", {{"value", 0.3}}}};
  const auto record = run_of(plan_of(quiet));
  const record::Scratch scratch;
  const auto apart = run_of(second_half(
      quiet, decided(record, MessageCode::kCalibrationTaken)->message.text(0), scratch));
  EXPECT_EQ(tips_of(record, 1), tips_of(apart, 0));
  const auto joined = evaluation::evaluate(record);
  const auto alone = evaluation::evaluate(apart);
  ASSERT_TRUE(joined->features.at(1).mz_cylinder && alone->features.at(0).mz_cylinder);
  EXPECT_EQ(joined->features[1].mz_cylinder->width_mm(),
            alone->features[0].mz_cylinder->width_mm());
  EXPECT_EQ(joined->features[1].levelling_pose, alone->features[0].levelling_pose);
  EXPECT_EQ(joined->fixture->residual_rms_mm, alone->fixture->residual_rms_mm);
}

/// Asks to stop before the touch after the next `touches`.
void stop_after(RunOptions& options, std::size_t touches) {
  options.stop_requested = [left = touches]() mutable { return left-- == 0; };
}

void expect_goes_on(const Plan& plan, const RunOptions& stopping, const std::string& bits) {
  {
    const auto run = run_plan(plan, stopping);
    ASSERT_TRUE(run && run->failure);
    ASSERT_EQ(run->failure->code, core::Code::kStopped) << run->failure->what;
  }
  {
    const auto run = resume_plan(plan, options_for(stopping.directory));
    ASSERT_TRUE(run) << run.error().front().what;
    ASSERT_FALSE(run->failure) << run->failure->what;
  }
  EXPECT_EQ(record::measured_bits(journal_of(stopping.directory)), bits);
}

/// A plan with a surface on either side of the calibration.
json surface_on_either_side() {
  json plan = example_18();
  json before = plan["features"][1];
  before["id"] = "nominal";
  plan["features"].insert(plan["features"].begin(), before);
  return plan;
}

TEST(JoinedCalibration, GoesOnToTheSameBitsBeforeAtAndAfterEachChange) {
  json few = surface_on_either_side();  // too few for a calibration that holds, and quick
  json& balls = few["features"][1]["rotary_axes"];
  balls["points"] = 5;
  balls["alpha_stations_deg"] = balls["beta_stations_deg"] = {-60, 20, 60};
  const Plan plan = plan_of(few);
  const auto whole = run_of(plan);
  const std::string bits = record::measured_bits(whole);
  std::vector<std::size_t> changes;
  for (const record::Decision& d : whole.decisions) {
    if (d.message.code != MessageCode::kClampingChanged) continue;
    EXPECT_EQ(d.message.text(2), "") << "a simulation answers itself";
    changes.push_back(static_cast<std::size_t>(d.message.number(0)));
  }
  ASSERT_EQ(changes.size(), 2U);
  for (const std::size_t change : changes) {
    for (const int after : {-1, 0, 1}) {  // 0: changed, and nothing touched since
      SCOPED_TRACE(::testing::Message() << "touch " << change << " and " << after);
      const record::Scratch scratch;
      RunOptions options = options_for(scratch / "run");
      stop_after(options, change + static_cast<std::size_t>(after));
      expect_goes_on(plan, options, bits);
      const auto journal = journal_of(scratch / "run");
      const record::Decision* resumed = decided(journal, MessageCode::kRunResumed);
      ASSERT_NE(resumed, nullptr);
      EXPECT_EQ(resumed->message.number(2) == 0.0, after == 0) << "nothing is there to repeat";
    }
    SCOPED_TRACE("before the answer");
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    std::size_t touches = 0;
    options.before_move = [&, change](const NextMove& move) -> core::Result<void> {
      touches += move.kind == NextMove::Kind::kTouch ? 1 : 0;
      if (touches < change || move.kind != NextMove::Kind::kTurn) return {};
      return core::fail(core::Code::kStopped, "here");
    };
    expect_goes_on(plan, options, bits);
  }
}

TEST(JoinedCalibration, ASurfaceBeforeItIsMeasuredInTheNominalFixture) {
  const auto result = evaluation::evaluate(run_of(plan_of(surface_on_either_side())));
  json hot = surface_on_either_side();
  hot["fixture"]["calibration"]["max_residual_um"] = 0.01;
  const auto refused = evaluation::evaluate(run_of(plan_of(hot)));
  using evaluation::Verdict;
  for (const auto& c : result->features.at(0).characteristics) EXPECT_NE(c.verdict, Verdict::kVoid);
  EXPECT_EQ(refused->features.at(0).mz_cylinder->width_mm(),
            result->features.at(0).mz_cylinder->width_mm());
  for (const auto& c : refused->features.at(0).characteristics) {
    EXPECT_NE(c.verdict, Verdict::kVoid);
  }
  for (const auto& c : refused->features.at(2).characteristics) {
    EXPECT_EQ(c.verdict, Verdict::kVoid);
    EXPECT_THAT(c.reason.english(), HasSubstr("the plan allows 0.01 um (max_residual_um)"));
  }
}

TEST(JoinedCalibration, AVoidOneMakesWhatFollowsVoid) {
  json warm = example_18();
  warm["simulation"]["temperature_degC"] = 22.5;
  const auto record = run_of(plan_of(warm));
  const record::Decision* taken = decided(record, MessageCode::kCalibrationTaken);
  ASSERT_NE(taken, nullptr);
  EXPECT_THAT(taken->message.text(0), HasSubstr("\"none\""));
  EXPECT_THAT(taken->message.text(1), HasSubstr("22.50 degC"));
  const auto result = evaluation::evaluate(record);
  for (const auto& c : result->features.at(1).characteristics) {
    EXPECT_EQ(c.verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(c.reason.english(),
                AllOf(HasSubstr("fixture F-01, which calibrates the fixture, is void: "),
                      HasSubstr("22.50 degC is outside 18..22 degC")));
  }
}

TEST(JoinedCalibration, AnotherOneThanTheTouchesGiveIsFound) {
  auto record = run_of(plan_of(example_18()));
  const auto honest = evaluation::evaluate(record);
  for (record::Decision& d : record.decisions) {
    if (d.message.code != MessageCode::kCalibrationTaken) continue;
    json taken = json::parse(d.message.text(0));
    json& shift_um = taken["alpha"]["stations"][2]["shift_um"][0];
    shift_um = shift_um.get<double>() + 0.01;
    d.message.arguments[0] = taken.dump();
  }
  const auto forged = evaluation::evaluate(record);
  ASSERT_FALSE(honest->fixture->invalid);
  ASSERT_TRUE(forged->fixture->invalid);
  EXPECT_THAT(forged->fixture->invalid->what, HasSubstr("another calibration of the fixture"));
  for (const auto& c : forged->features.at(1).characteristics) {
    EXPECT_EQ(c.verdict, evaluation::Verdict::kVoid);
  }
}

}  // namespace
}  // namespace rondure::plans::joined
