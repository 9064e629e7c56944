#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "record/points/points.h"
#include "tests/record/sample_run.h"

namespace rondure::plans::testing {

inline std::filesystem::path source_dir() { return RONDURE_SOURCE_DIR; }
inline std::filesystem::path example(const std::string& name) {
  return source_dir() / "plans" / "examples" / name;
}

/// Set RONDURE_REWRITE=1 to rewrite the committed files that tests compare with; review the diff.
inline bool rewriting() { return std::getenv("RONDURE_REWRITE") != nullptr; }

inline std::string bytes_of(const std::filesystem::path& path) {
  return record::read_file(path).value_or("");
}

/// The plans of a folder, sorted by name.
inline std::vector<std::filesystem::path> plans_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// One line per problem; empty when there is a plan.
inline std::string lines_of(const PlanOrProblems& result) {
  std::string out;
  if (result) return out;
  for (const core::Error& problem : result.error()) out += core::to_line(problem) + "\n";
  return out;
}

/// An example plan; fails the test when it is missing or has problems.
inline Plan plan_of(const std::string& example_name) {
  auto plan = read_plan(example(example_name));
  EXPECT_TRUE(plan) << lines_of(plan);
  return std::move(plan).value();  // throws: this test fails, the others continue
}

/// Options that give every test the same run name and start.
inline RunOptions options_for(const std::filesystem::path& directory) {
  RunOptions options;
  options.directory = directory;
  options.run_id = "run";
  options.plan_file = "plan.json";
  options.started_utc = "2026-11-21T02:33:02Z";
  return options;
}

/// The record in a journal; fails the test when it cannot be read.
inline record::RunRecord journal_of(const std::filesystem::path& directory) {
  auto read = record::read_journal(directory);
  EXPECT_TRUE(read) << (read ? "" : read.error().what);
  return read ? std::move(read->record) : record::RunRecord();
}

/// A run in a folder that is not kept: what its journal holds, and why it did not finish.
struct Ran {
  std::optional<core::Error> failure;
  record::RunRecord record;
};

/// Runs a plan; fails the test when it has problems or the run does not begin.
inline Ran ran(const PlanOrProblems& plan) {
  const record::Scratch scratch;
  Ran out;
  EXPECT_TRUE(plan) << lines_of(plan);
  if (!plan) return out;
  const auto run = run_plan(*plan, options_for(scratch / "run"));
  EXPECT_TRUE(run) << (run ? "" : run.error().what);
  if (run) out.failure = run->failure;
  out.record = journal_of(scratch / "run");
  return out;
}

}  // namespace rondure::plans::testing

namespace rondure::plans {

/// resume_plan() of the run in `options.directory`.
inline RunOrRefusals resume_plan(const Plan& plan, const RunOptions& options) {
  auto held = record::hold_journal(options.directory);
  if (!held) return tl::unexpected(std::vector<core::Error>{held.error()});
  return resume_plan(plan, options, *std::move(held));
}

namespace testing {

/// Stops the run before the touch after each of these numbers of touches: resumed, it must measure
/// the bits of a run without interruption.
inline void expect_resumed_bits(const Plan& plan, std::initializer_list<int> numbers) {
  const record::Scratch whole;
  const auto run = run_plan(plan, options_for(whole / "run"));
  ASSERT_TRUE(run && !run->failure);
  const std::string bits = record::measured_bits(journal_of(whole / "run"));
  for (const int touches : numbers) {
    SCOPED_TRACE(touches);
    const record::Scratch scratch;
    RunOptions options = options_for(scratch / "run");
    options.stop_requested = [left = touches]() mutable { return left-- == 0; };
    {
      const auto stopped = run_plan(plan, options);
      ASSERT_TRUE(stopped && stopped->failure);
    }
    const auto resumed = resume_plan(plan, options_for(scratch / "run"));
    ASSERT_TRUE(resumed && !resumed->failure) << (resumed ? resumed->failure->what : "refused");
    EXPECT_EQ(record::measured_bits(journal_of(scratch / "run")), bits);
  }
}

}  // namespace testing
}  // namespace rondure::plans
