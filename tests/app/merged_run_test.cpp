// A part in two poses: the example against its hidden truth, merged by kinematics, interrupted, and
// what is refused.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/record/sample_run.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// The example with other values.
void write_merged(const fs::path& file, const std::vector<Change>& changes) {
  auto plan = nlohmann::ordered_json::parse(read(example("04_part_in_two_poses.json")));
  plan.erase("$schema");
  for (const Change& change : changes)
    plan[nlohmann::ordered_json::json_pointer(change.pointer)] = change.value;
  write(file, plan.dump(2));
}

json report_of(const fs::path& run) { return json::parse(read(run / "report.json")); }

TEST(MergedRun, SolvedTogetherTheErrorsOfTheFixtureAreTakenOut) {
  const Scratch folder;
  for (const int seed : {4, 5, 6}) {
    SCOPED_TRACE(seed);
    const fs::path run = folder / std::to_string(seed);
    ASSERT_LE(rondure({"run", example("04_part_in_two_poses.json"), "--out", run, "--seed",
                       std::to_string(seed)})
                  .status,
              1);
    const json report = report_of(run);
    const json merged = report.at("/features/0/merged"_json_pointer);
    const double truth_um =
        report.at("/features/0/characteristics/0/simulation/0/truth_um"_json_pointer);
    const double joint_um = report.at("/features/0/mz/deviation_um"_json_pointer);
    const double naive_um = merged.at("kinematics_cylt_um");
    EXPECT_NEAR(joint_um, merged.at("joint_cylt_um"), 1e-6);
    EXPECT_GT(std::abs(naive_um - truth_um), 0.5 * truth_um);
    // Four touches of 0.2 um each: 0.1 um a point, which widens any zone by some of them.
    EXPECT_NEAR(joint_um, truth_um, 0.1 * truth_um + 0.3);
    EXPECT_NEAR(merged.at("fixture_share_um"), naive_um - joint_um, 1e-6);
    EXPECT_GT(merged.at("shared_targets"), 15);
    EXPECT_EQ(merged.at("poses").size(), 2U);
    EXPECT_LT(merged.at("chi2"), merged.at("chi2_limit"));
    EXPECT_THAT(read(run / "report.html"),
                AllOf(HasSubstr("Several poses, one part"), HasSubstr("number above a point")));
    fmt::print("seed {}: hidden truth {:.3f} um, kinematics {:.3f} um, joint {:.3f} um\n", seed,
               truth_um, naive_um, joint_um);
  }
}

TEST(MergedRun, ByKinematicsTheFixtureIsBelievedAndItsShareTold) {
  const Scratch folder;
  write_merged(folder / "plan.json", {{"/features/0/pose_search/merge", "kinematics"}});
  ASSERT_LE(rondure({"run", folder / "plan.json", "--out", folder / "run"}).status, 1);
  const json report = report_of(folder / "run");
  const json merged = report.at("/features/0/merged"_json_pointer);
  EXPECT_NEAR(report.at("/features/0/mz/deviation_um"_json_pointer),
              merged.at("kinematics_cylt_um"), 1e-6);
  EXPECT_GT(merged.at("u_kinematics_um"), merged.at("u_joint_um"));
  EXPECT_THAT(merged.at("in_words"), HasSubstr("by the kinematics alone"));
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
}

TEST(MergedRun, InterruptedInEitherPoseItEndsWithTheSameBits) {
  const Scratch folder;
  write_merged(folder / "whole.json", {});
  ASSERT_LE(rondure({"run", folder / "whole.json", "--out", folder / "whole"}).status, 1);
  record::RunRecord whole = journal_of(folder / "whole");
  const auto touches = static_cast<int>(whole.touches.size());
  for (const int at : {touches / 3, 3 * touches / 4}) {
    SCOPED_TRACE(at);
    const fs::path plan = folder / fmt::format("{}.json", at);
    const fs::path run = folder / fmt::format("{}", at);
    write_merged(plan, {{"/simulation/faults", {{"connection_lost_at_touch", at}}}});
    EXPECT_EQ(rondure({"run", plan, "--out", run}).status, 3);
    EXPECT_LE(rondure({"run", plan, "--out", run, "--resume"}).status, 1);
    const record::RunRecord resumed = journal_of(run);
    whole.header.plan_file = resumed.header.plan_file;
    whole.header.plan_text = resumed.header.plan_text;
    whole.header.plan_sha256 = resumed.header.plan_sha256;
    EXPECT_EQ(record::measured_bits(resumed), record::measured_bits(whole));
    EXPECT_EQ(report_of(run).at("features"), report_of(folder / "whole").at("features"));
  }
}

TEST(MergedRun, ATargetThatNoPoseReachesIsNamedBeforeAnythingMoves) {
  const Scratch folder;
  write_merged(folder / "plan.json", {{"/features/0/pose_search/poses/1/alpha_deg", 40}});
  const Outcome outcome = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("/features/0/pose_search/poses"),
                                 HasSubstr("in none of the poses"), HasSubstr("[unreachable]")));
  EXPECT_FALSE(fs::exists(folder / "run"));
}

}  // namespace
}  // namespace rondure::app::testing
