// Runs that are interrupted at any touch go on and end as if nothing had happened. The program's
// own death by kill -9 is in tests/app/resume_kill_test.cpp. A sample of touches; all of them with
// RONDURE_FULL=1.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/version.h"
#include "plans/resume/internal/recorded_run.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "tests/core/full.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::journal_of;
using testing::options_for;
using testing::plan_of;

/// Asks to stop before the touch after the next `touches`.
void stop_after(RunOptions& options, int touches) {
  options.stop_requested = [left = touches]() mutable { return left-- == 0; };
}

/// A simulation is more than its text: `change` gives the plan another text as well.
Plan with(Plan plan, const std::string& from, const std::string& to) {
  std::string text = plan.text;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  auto changed = parse_plan(text.replace(at, from.size(), to), plan.folder, "plan.json");
  EXPECT_TRUE(changed) << testing::lines_of(changed);
  return std::move(changed).value();
}

/// The plan without an interruption.
struct Whole {
  record::RunRecord record;
  std::string bits;

  explicit Whole(const Plan& plan) {
    const record::Scratch scratch;
    const auto run = run_plan(plan, options_for(scratch / "run"));
    EXPECT_TRUE(run && !run->failure);
    record = journal_of(scratch / "run");
    bits = record::measured_bits(record);
  }
};

void expect_goes_on(const Plan& plan, const fs::path& directory, const Whole& whole) {
  const auto run = resume_plan(plan, options_for(directory));
  ASSERT_TRUE(run) << run.error().front().what;
  ASSERT_FALSE(run->failure) << run->failure->what;
  const auto record = journal_of(directory);
  EXPECT_EQ(record::measured_bits(record), whole.bits);
}

std::vector<int> touches_to_stop_at(std::size_t all) {
  std::vector<int> out;
  std::uint64_t state = 5;
  for (std::size_t k = 0; k < all; ++k) {
    // The borders between qualification, location, first cloud; elsewhere by chance.
    const bool border = k < 2 || k == 13 || k == 19 || k == 20 || k == 47 || k + 1 == all;
    if (test::full() || border || core::splitmix64(state) % 60 == 0)
      out.push_back(static_cast<int>(k));
  }
  return out;
}

TEST(ResumeDecisions, AreTheSameInOtherWordsAndNotWithOtherNumbers) {
  using core::MessageCode;
  const auto decided = [](MessageCode code, std::vector<core::Argument> arguments) {
    return record::Decision{0, 1.0, {code, std::move(arguments)}};
  };
  const auto known =
      decided(MessageCode::kLevelPoseUnreachable, {"point 3: the stem meets the clamp"});
  EXPECT_TRUE(check_same_step(
      known, decided(MessageCode::kLevelPoseUnreachable, {"the stem would touch the clamp"})));
  const auto step = [&](double zone_um) {
    return decided(MessageCode::kLevelToScatter, {1.41, -1.706, zone_um, 0.013641});
  };
  EXPECT_TRUE(check_same_step(step(4.768), step(4.76849)));
  const auto other = check_same_step(step(4.768), step(4.770));
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, core::Code::kJournal);
  EXPECT_THAT(other.error().what,
              AllOf(HasSubstr("it decided level-to-scatter {"), HasSubstr("\"zone_um\":4.768"),
                    HasSubstr("now it would be level-to-scatter {")));
  EXPECT_FALSE(check_same_step(step(4.768), known));
}

class Resume : public ::testing::TestWithParam<const char*> {};

TEST_P(Resume, EndsWithTheSameBitsWhereverTheRunWasStopped) {
  const Plan plan = plan_of(GetParam());
  const Whole whole(plan);
  for (const int touches : touches_to_stop_at(whole.record.touches.size())) {
    SCOPED_TRACE(touches);
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    stop_after(options, touches);
    {
      const auto run = run_plan(plan, options);
      ASSERT_TRUE(run && run->failure);
      ASSERT_EQ(run->failure->code, core::Code::kStopped);
    }
    ASSERT_EQ(journal_of(scratch / "run").touches.size(), static_cast<std::size_t>(touches));
    expect_goes_on(plan, scratch / "run", whole);
    const auto record = journal_of(scratch / "run");
    EXPECT_EQ(record.checks.empty(), touches == 0);
    EXPECT_LE(record.checks.size(), 3U);
  }
}

INSTANTIATE_TEST_SUITE_P(Strategies, Resume,
                         ::testing::Values("01_spool_simulated.json", "14_bore_simulated.json",
                                           "13_pose_search_virtual.json"));

TEST(ResumeOften, GoesOnAfterEveryFewTouches) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const Whole whole(plan);
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 9);
  std::size_t checks = 0;
  {
    const auto run = run_plan(plan, options);
    ASSERT_TRUE(run && run->failure);
  }
  for (int i = 0; i < 100; ++i) {
    stop_after(options, 9);
    const auto run = resume_plan(plan, options);
    ASSERT_TRUE(run) << run.error().front().what;
    if (!run->failure) break;
    ASSERT_EQ(run->failure->code, core::Code::kStopped);
    checks += 3;
  }
  const auto record = journal_of(scratch / "run");
  EXPECT_EQ(record.ending, "finished");
  EXPECT_EQ(record::measured_bits(record), whole.bits);
  EXPECT_GT(record.checks.size(), checks / 2);
  for (std::size_t i = 0; i < record.checks.size(); ++i) {
    EXPECT_EQ(record.checks[i].id, -1 - static_cast<std::int64_t>(i));
  }
}

TEST(ResumeChecks, HaveNoiseOfTheirOwnAndStayWithinTheLimit) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 60);
  (void)run_plan(plan, options);
  (void)resume_plan(plan, options_for(scratch / "run"));
  const auto record = journal_of(scratch / "run");
  ASSERT_EQ(record.checks.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const record::Touch& check = record.checks[i];
    const record::Touch& repeated = record.touches[57 + i];
    EXPECT_EQ(check.pose, repeated.pose);
    EXPECT_EQ(check.point, repeated.point);
    const double difference_mm = (check.tip_mm - repeated.tip_mm).norm();
    EXPECT_GT(difference_mm, 0.0);
    EXPECT_LT(difference_mm, 5e-3);
  }
  ASSERT_FALSE(record.decisions.empty());
  EXPECT_TRUE(
      std::any_of(record.decisions.begin(), record.decisions.end(), [](const record::Decision& d) {
        return d.feature == -1 && d.message.code == core::MessageCode::kRunResumed &&
               d.message.number(1) == 60.0 && d.message.number(2) == 3.0;
      }));
}

TEST(ResumeChecks, EndTheRunWhenThePartHasMoved) {
  const Plan still = plan_of("01_spool_simulated.json");
  const Plan plan =
      with(still, "\"seed\": 20261121", "\"faults\": {\"part_moved_um\": 30}, \"seed\": 20261121");
  for (const int touches : {30, 70, 120}) {  // location, a cloud, the repeats
    SCOPED_TRACE(touches);
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    stop_after(options, touches);
    (void)run_plan(plan, options);
    const auto run = resume_plan(plan, options_for(scratch / "run"));
    ASSERT_TRUE(run);
    ASSERT_TRUE(run->failure);
    EXPECT_EQ(run->failure->code, core::Code::kLocation);
    EXPECT_THAT(run->failure->what,
                AllOf(HasSubstr("differs by "), HasSubstr("the plan allows 5 um"),
                      HasSubstr("resume_limit_um"), HasSubstr("start a new run")));
    EXPECT_FALSE(is_resumable(*run->failure));
    EXPECT_EQ(journal_of(scratch / "run").touches.size(), static_cast<std::size_t>(touches));
  }
}

/// Touches of the pose that is evaluated, by (layer, point, repeat): each once.
std::size_t final_touches(const record::RunRecord& record) {
  int last = -1;
  for (const record::PoseVisit& visit : record.poses) {
    if (visit.final_cloud) last = visit.id;
  }
  std::size_t count = 0;
  for (const record::Touch& touch : record.touches) count += touch.pose == last ? 1 : 0;
  return count;
}

TEST(ResumeRelocates, APartThatHasMovedAndMeasuresItsCloudAnew) {
  const Plan plan = with(plan_of("01_spool_simulated.json"), "\"seed\": 20261121",
                         "\"faults\": {\"part_moved_um\": 300}, \"seed\": 20261121");
  const Whole whole(plan_of("01_spool_simulated.json"));
  for (const int touches : {16, 30, 70, 120}) {  // location, a cloud, the next one, the repeats
    SCOPED_TRACE(touches);
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    stop_after(options, touches);
    (void)run_plan(plan, options);
    options = options_for(scratch / "run");
    options.relocate = true;
    // Interrupted once more behind the relocation: the journal tells the way.
    stop_after(options, 9);
    {
      const auto run = resume_plan(plan, options);
      ASSERT_TRUE(run && run->failure);
      ASSERT_EQ(run->failure->code, core::Code::kStopped) << run->failure->what;
    }
    stop_after(options, 1'000'000);
    {
      const auto run = resume_plan(plan, options);
      ASSERT_TRUE(run);
      ASSERT_FALSE(run->failure) << run->failure->what;
    }
    const auto record = journal_of(scratch / "run");
    EXPECT_EQ(record.ending, "finished");
    EXPECT_EQ(final_touches(record), 5U * 28U);
    EXPECT_GT(record.touches.size(), whole.record.touches.size());
    const record::Series* const truth = record.truth_series_of(0, record::kTrueTips);
    ASSERT_NE(truth, nullptr);
    EXPECT_EQ(truth->rows(), record.touches.size()) << "of each placement";
    EXPECT_TRUE(std::any_of(
        record.decisions.begin(), record.decisions.end(), [&](const record::Decision& d) {
          return d.feature == -1 && d.message.code == core::MessageCode::kPartLocatedAgain &&
                 d.message.number(0) == touches;
        }));
  }
}

TEST(ResumeRelocates, NotBetweenTwoClouds) {
  const Plan plan = with(plan_of("01_spool_simulated.json"), "\"seed\": 20261121",
                         "\"faults\": {\"part_moved_um\": 300}, \"seed\": 20261121");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 13 + 6);
  (void)run_plan(plan, options);
  options = options_for(scratch / "run");
  options.relocate = true;
  const auto run = resume_plan(plan, options);
  ASSERT_TRUE(run && run->failure);
  EXPECT_EQ(run->failure->code, core::Code::kLocation);
  EXPECT_THAT(run->failure->what, HasSubstr("between two clouds"));
}

TEST(ResumeRelocates, NothingThatHasNotMoved) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const Whole whole(plan);
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 70);
  (void)run_plan(plan, options);
  options = options_for(scratch / "run");
  options.relocate = true;
  {
    const auto run = resume_plan(plan, options);
    ASSERT_TRUE(run && !run->failure);
  }
  EXPECT_EQ(record::measured_bits(journal_of(scratch / "run")), whole.bits);
}

TEST(ResumeChecks, EndTheRunWhenTheFixtureReadsAnotherPoseThanItDid) {
  const Plan still = plan_of("01_spool_simulated.json");
  // In a pose that was reached without a touch in it, and in poses with touches.
  for (const int touches : {13, 30, 120}) {
    for (const double off_deg : {0.11, -0.11}) {
      if (!test::full() && (touches == 30) == (off_deg > 0.0)) continue;
      SCOPED_TRACE(::testing::Message() << touches << " touches, " << off_deg << " deg");
      const Plan plan = with(
          still, "\"seed\": 20261121",
          "\"faults\": {\"fixture_off_deg\": " + std::to_string(off_deg) + "}, \"seed\": 20261121");
      const record::Scratch scratch;
      RunOptions options = options_for(scratch / "run");
      stop_after(options, touches);
      (void)run_plan(plan, options);
      const auto run = resume_plan(plan, options_for(scratch / "run"));
      ASSERT_TRUE(run && run->failure);
      EXPECT_EQ(run->failure->code, core::Code::kMachine);
      EXPECT_THAT(run->failure->what,
                  AllOf(HasSubstr("the fixture reads ("), HasSubstr("0.11 deg apart"),
                        HasSubstr("allows 0.05 deg (resolution_deg)")));
      EXPECT_TRUE(is_resumable(*run->failure)) << "a fixture can be put right";
      EXPECT_EQ(journal_of(scratch / "run").touches.size(), static_cast<std::size_t>(touches));
    }
  }
}

TEST(ResumeChecks, LetTheFixtureReadOneStepOfItsResolutionBeside) {
  const Plan plan = with(plan_of("01_spool_simulated.json"), "\"seed\": 20261121",
                         "\"faults\": {\"fixture_off_deg\": 0.05}, \"seed\": 20261121");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 13);
  (void)run_plan(plan, options);
  const auto run = resume_plan(plan, options_for(scratch / "run"));
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->failure) << run->failure->what;
}

TEST(ResumeChecks, TakeTheirLimitFromThePlan) {
  const Plan plan = with(with(plan_of("01_spool_simulated.json"), "\"seed\": 20261121",
                              "\"faults\": {\"part_moved_um\": 30}, \"seed\": 20261121"),
                         "\"approach_mm\": 3", "\"resume_limit_um\": 50, \"approach_mm\": 3");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 70);
  (void)run_plan(plan, options);
  const auto run = resume_plan(plan, options_for(scratch / "run"));
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->failure);
}

class Fault : public ::testing::TestWithParam<const char*> {};

TEST_P(Fault, IsResumedWithTheSameBits) {
  const Plan plan = with(plan_of("01_spool_simulated.json"), "\"seed\": 20261121",
                         std::string("\"faults\": {") + GetParam() + "}, \"seed\": 20261121");
  const Whole whole(plan_of("01_spool_simulated.json"));
  const record::Scratch scratch;
  {
    const auto run = run_plan(plan, options_for(scratch / "run"));
    ASSERT_TRUE(run && run->failure);
    EXPECT_EQ(run->failure->code, core::Code::kMachine);
    EXPECT_TRUE(is_resumable(*run->failure));
  }
  EXPECT_EQ(journal_of(scratch / "run").ending, "failed");
  const auto run = resume_plan(plan, options_for(scratch / "run"));
  ASSERT_TRUE(run && !run->failure);
  auto record = journal_of(scratch / "run");
  record.header.plan_text = whole.record.header.plan_text;
  record.header.plan_sha256 = whole.record.header.plan_sha256;
  EXPECT_EQ(record::measured_bits(record), whole.bits);
}

INSTANTIATE_TEST_SUITE_P(Each, Fault,
                         ::testing::Values("\"connection_lost_at_touch\": 1",
                                           "\"connection_lost_at_touch\": 5",
                                           "\"connection_lost_at_touch\": 90",
                                           "\"fixture_stalls_at_move\": 1",
                                           "\"fixture_stalls_at_move\": 2"));

TEST(ResumeRefuses, AChangedPlanAndLeavesTheJournalAsItWas) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 40);
  (void)run_plan(plan, options);
  const std::string journal = testing::bytes_of(scratch / "run/journal.db");
  const Plan other = with(plan, "\"approach_mm\": 3", "\"approach_mm\": 2.5");
  const auto run = resume_plan(other, options_for(scratch / "run"));
  ASSERT_FALSE(run);
  ASSERT_EQ(run.error().size(), 1U);
  EXPECT_EQ(run.error().front().where, "/machine/approach_mm");
  EXPECT_THAT(run.error().front().what, AllOf(HasSubstr("began with 3,"), HasSubstr("says 2.5")));
  EXPECT_EQ(testing::bytes_of(scratch / "run/journal.db"), journal);
  EXPECT_EQ(journal_of(scratch / "run").ending, "stopped");
}

TEST(ResumeRefuses, AnotherSeedSerialNumberOrOperator) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  options.serial = "0042";
  options.operator_name = "mk";
  stop_after(options, 40);
  (void)run_plan(plan, options);
  RunOptions other = options_for(scratch / "run");
  other.serial = "0043";
  other.operator_name = "ab";
  other.seed = 7;
  const auto run = resume_plan(plan, other);
  ASSERT_FALSE(run);
  ASSERT_EQ(run.error().size(), 3U);
  EXPECT_THAT(run.error()[0].what, AllOf(HasSubstr("seed"), HasSubstr("20261121")));
  EXPECT_THAT(run.error()[1].what, AllOf(HasSubstr("0042"), HasSubstr("0043")));
  EXPECT_THAT(run.error()[2].what, HasSubstr("operator"));
}

TEST(ResumeRefuses, AnotherVersionOfTheProgram) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  stop_after(options, 40);
  (void)run_plan(plan, options);
  record::RunRecord old = journal_of(scratch / "run");
  old.header.version = "0.0.9";
  {
    auto journal = record::Journal::create(scratch / "old", old.header, old.artefact, old.features,
                                           old.settings);
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal->add(old.touches));
  }
  const auto run = resume_plan(plan, options_for(scratch / "old"));
  ASSERT_FALSE(run);
  ASSERT_EQ(run.error().size(), 1U);
  EXPECT_THAT(run.error().front().what, AllOf(HasSubstr("program version"), HasSubstr("\"0.0.9\""),
                                              HasSubstr(core::kVersion)));
}

TEST(ResumeRefuses, AnotherPointsFile) {
  const record::Scratch scratch;
  fs::copy_file(testing::example("09_axle_points_file.json"), scratch / "plan.json");
  const auto original = read_plan(testing::example("09_axle_points_file.json"));
  ASSERT_TRUE(original);
  const std::string name = original->features.front().source->file;
  fs::path points = fs::path(scratch.path()) / "plans" / "examples" / name;
  fs::create_directories(points.parent_path());
  fs::create_directories(scratch / "plans/examples");
  fs::copy_file(original->folder / name, points);
  const auto plan = parse_plan(original->text, scratch / "plans/examples", "plan.json");
  ASSERT_TRUE(plan) << testing::lines_of(plan);
  {
    const auto run = run_plan(*plan, options_for(scratch / "run"));
    ASSERT_TRUE(run && !run->failure);
  }
  ASSERT_TRUE(record::write_file(points, testing::bytes_of(points) + "# more\n"));
  const auto run = resume_plan(*plan, options_for(scratch / "run"));
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().front().where, "/features/0/source/file");
  EXPECT_THAT(run.error().front().what, HasSubstr("changed since the run began"));
}

TEST(ResumeFinished, NeedsNoMachineWhenEveryTouchWasMade) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const Whole whole(plan);
  const record::Scratch scratch;
  (void)run_plan(plan, options_for(scratch / "run"));  // dies before it is sealed
  expect_goes_on(plan, scratch / "run", whole);
  EXPECT_TRUE(journal_of(scratch / "run").checks.empty());
}

TEST(ResumeClock, DoesNotMindThatTheClockOfTheComputerJumpedBack) {
  const Plan plan = plan_of("01_spool_simulated.json");
  const Whole whole(plan);
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  options.started_utc = "2099-12-31T23:59:59Z";
  stop_after(options, 40);
  (void)run_plan(plan, options);
  options = options_for(scratch / "run");
  options.started_utc = "1970-01-01T00:00:00Z";
  {
    const auto run = resume_plan(plan, options);
    ASSERT_TRUE(run && !run->failure);
  }
  EXPECT_EQ(record::measured_bits(journal_of(scratch / "run")), whole.bits);
  EXPECT_EQ(journal_of(scratch / "run").header.started_utc, "2099-12-31T23:59:59Z");
}

}  // namespace
}  // namespace rondure::plans
