// Runs whose data are series, killed before, between and behind the series of their features: they
// go on and end with the same bits.

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plans/analyses/features.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::options_for;

Plan plan_from(const std::string& text, const fs::path& folder = {}) {
  auto plan = parse_plan(text, folder, "plan.json");
  if (!plan) throw std::runtime_error(testing::lines_of(plan));
  return std::move(*plan);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

record::RunRecord unbroken_journal_of(const fs::path& directory) {
  auto read = record::read_journal(directory);
  EXPECT_TRUE(read) << (read ? "" : read.error().what);
  if (!read) return {};
  EXPECT_TRUE(read->broken.empty());
  return std::move(read->record);
}

/// The plan without an interruption, with a seed that only the command line gave.
record::RunRecord whole_run(const Plan& plan) {
  const record::Scratch scratch;
  RunOptions options = options_for(scratch / "run");
  options.seed = 99;
  const auto run = run_plan(plan, options);
  EXPECT_TRUE(run && !run->failure);
  return unbroken_journal_of(scratch / "run");
}

/// Leaves file and log of a run that was killed behind the series of its first features.
void leave_killed(const record::RunRecord& whole, int features, const fs::path& directory) {
  const record::Scratch live;
  auto journal = record::Journal::create(live / "run", whole.header, whole.artefact, whole.features,
                                         whole.settings);
  ASSERT_TRUE(journal);
  for (int i = 0; i < features; ++i) {
    std::vector<record::Series> series = whole.series;
    std::erase_if(series, [&](const auto& one) { return one.feature != i; });
    std::vector<record::TruthValue> truths = whole.truth_values;
    std::erase_if(truths, [&](const auto& one) { return one.feature != i; });
    ASSERT_TRUE(journal->add(series, truths));
  }
  fs::create_directory(directory);
  for (const char* name : {"journal.db", "journal.db-wal"}) {
    if (fs::exists(live / "run" / name)) fs::copy_file(live / "run" / name, directory / name);
  }
}

void expect_goes_on(const Plan& plan, const fs::path& directory, const record::RunRecord& whole) {
  {
    const auto run = resume_plan(plan, options_for(directory));
    ASSERT_TRUE(run) << run.error().front().what;
    ASSERT_FALSE(run->failure) << run->failure->what;
  }
  const auto record = unbroken_journal_of(directory);
  EXPECT_EQ(record.ending, "finished");
  EXPECT_TRUE(record::measured_bits(record) == record::measured_bits(whole)) << "bits differ";
}

/// A short spindle record in front of what else the plan has.
std::string with_spindle_first(const std::string& text) {
  const std::string with_feature = with(text, "\"features\": [", R"("features": [
    { "id": "pin", "type": "spindle", "spindle": { "layout": "reference", "samples": 256, "highest_order": 20, "cutoff_upr": 20 },
      "characteristics": [ { "id": "RONt", "form": "roundness" } ] },)");
  return with(with_feature, "\"simulation\": {", R"("simulation": {
    "spindle": { "turns": 2, "samples_per_turn": 256, "probe_noise_um": 0.05,
                 "profile": [ { "order": 3, "amplitude_um": 2.0, "phase_deg": 10 } ] },)");
}

/// A contour whose data stand in files below `folder`.
std::string contour_from_files(const fs::path& folder) {
  for (const char* name : {"axes1.csv", "pin1.csv"}) {
    fs::copy_file(testing::source_dir() / "tests/data/spec_contour" / name, folder / name);
  }
  return R"({ "plan": { "name": "pin", "revision": "A" }, "part": { "id": "CS-4", "name": "crankshaft" }, "features": [ {
    "id": "pin", "type": "contour",
    "contour": { "crank_radius_mm": 49.0, "wheel_radius_mm": 299.88, "pin_radius_mm": 24.56,
                 "parts": [ { "name": "1", "axes": "axes1.csv", "pin": "pin1.csv" } ] },
    "characteristics": [ { "id": "contour", "form": "contour-deviation", "tolerance_um": 15 } ] } ] })";
}

class ResumeSeries : public ::testing::TestWithParam<const char*> {};

TEST_P(ResumeSeries, EndWithTheSameBitsWhereverTheRunWasKilled) {
  const Plan plan = plan_from(testing::bytes_of(testing::example(GetParam())));
  const record::RunRecord whole = whole_run(plan);
  ASSERT_FALSE(whole.series.empty());
  ASSERT_EQ(whole.header.seed, 99U);
  for (const int written : {0, 1}) {
    SCOPED_TRACE(written);
    const record::Scratch scratch;
    leave_killed(whole, written, scratch / "run");
    ASSERT_EQ(unbroken_journal_of(scratch / "run").series.empty(), written == 0);
    expect_goes_on(plan, scratch / "run", whole);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ResumeSeries,
                         ::testing::Values("05_spindle_three_probe.json", "06_wheel.json",
                                           "07_crank_pin.json"));

TEST(ResumeSeriesOf, TwoFeaturesGoOnBetweenThem) {
  const Plan plan =
      plan_from(with_spindle_first(testing::bytes_of(testing::example("06_wheel.json"))));
  const record::RunRecord whole = whole_run(plan);
  for (const int written : {0, 1, 2}) {
    SCOPED_TRACE(written);
    const record::Scratch scratch;
    leave_killed(whole, written, scratch / "run");
    expect_goes_on(plan, scratch / "run", whole);
    expect_goes_on(plan, scratch / "run", whole);  // not sealed yet: once more changes nothing
  }
}

TEST(ResumeSeriesOf, APlanThatAlsoTouchesGoOnWhereverItWasStopped) {
  const std::string spool = testing::bytes_of(testing::example("01_spool_simulated.json"));
  const Plan plan = plan_from(with_spindle_first(with(spool, "\"layers\": 4", "\"layers\": 2")));
  const record::RunRecord whole = whole_run(plan);
  ASSERT_EQ(whole.series.front().feature, 0);
  for (const int touches : {5, 30}) {  // before and behind the series
    SCOPED_TRACE(touches);
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    options.seed = 99;
    options.stop_requested = [left = touches]() mutable { return left-- == 0; };
    {
      const auto run = run_plan(plan, options);
      ASSERT_TRUE(run && run->failure);
    }
    ASSERT_EQ(unbroken_journal_of(scratch / "run").series.empty(), touches < 13);
    expect_goes_on(plan, scratch / "run", whole);
  }
}

TEST(ResumeSeriesOf, FilesNeedsTheSameFiles) {
  const record::Scratch scratch;
  const Plan plan = plan_from(contour_from_files(scratch.path()), scratch.path());
  const record::RunRecord whole = whole_run(plan);
  EXPECT_EQ(whole.features[0].points_file, "axes1.csv, pin1.csv");
  EXPECT_FALSE(whole.header.simulated);
  for (const int written : {0, 1}) {
    const fs::path run = scratch / ("run" + std::to_string(written));
    leave_killed(whole, written, run);
    const std::string bytes = testing::bytes_of(scratch / "pin1.csv");
    ASSERT_TRUE(record::write_file(scratch / "pin1.csv", bytes + "# more\n"));
    const auto refused = resume_plan(plan, options_for(run));
    ASSERT_TRUE(record::write_file(scratch / "pin1.csv", bytes));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().front().where, "/features/0/contour/parts");
    EXPECT_THAT(refused.error().front().what,
                HasSubstr("the points of axes1.csv, pin1.csv changed since the run began"));
    expect_goes_on(plan, run, whole);
  }
}

TEST(SimulatesAnalysis, WhereSeriesAreNeitherReadNorTouched) {
  const record::Scratch scratch;
  const std::string touched = testing::bytes_of(testing::example("01_spool_simulated.json"));
  EXPECT_FALSE(simulates_analysis(plan_from(touched)));
  EXPECT_TRUE(simulates_analysis(plan_from(with_spindle_first(touched))));
  EXPECT_FALSE(simulates_analysis(plan_from(contour_from_files(scratch.path()), scratch.path())));
}

}  // namespace
}  // namespace rondure::plans
