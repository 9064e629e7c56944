// The program itself on damaged runs and data files. With RONDURE_FULL=all 700 cases a door.

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "record/checksums.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/overheard.h"
#include "tests/fuzz/run_samples.h"
#include "tests/fuzz/seeds.h"

namespace rondure::fuzz {
namespace {

namespace fs = std::filesystem;

/// How one call of the program ends: with an exit status of its own, in time, and with a sentence
/// where it refuses.
std::string wrong_with_call(const std::vector<std::string>& words) {
  std::string command = "rondure";
  for (const std::string& word : words) command += " " + word;
  app::testing::Program program(words);
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!program.ended()) {
    if (std::chrono::steady_clock::now() > end) return command + ": no end";
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const auto outcome = program.wait();
  if (outcome.signal != 0) return fmt::format("{}: signal {}", command, outcome.signal);
  if (outcome.status < 0 || outcome.status > 3) {
    return fmt::format("{}: exit status {}: {}", command, outcome.status, outcome.err);
  }
  if (outcome.status > 1 && outcome.err.empty()) return command + ": refused without a word";
  if (auto wrong = wrong_with_text(outcome.out); !wrong.empty()) return command + ": " + wrong;
  if (outcome.status > 1) return {};  // a refusal may name the number that it found
  if (auto wrong = wrong_with_text(outcome.err); !wrong.empty()) return command + ": " + wrong;
  return {};
}

TEST(ProgramFuzz, NoResealedRunUpsetsAVerb) {
  const fs::path run = work_folder() / "program-run";
  const std::string archive = (work_folder() / "program-archive.db").string();
  ASSERT_FALSE(sample_runs().empty());
  try_cases({15, 700}, [&](unsigned seed) {
    write_resealed_run(run, seed);
    const std::vector<std::vector<std::string>> calls = {
        {"verify", run.string()},
        {"report", run.string(), "--format", "html,json,csv"},
        {"compare", run.string(), "--json"},
        {"history", archive, "--add", run.string()},
        {"run", run.string(), "--resume"}};
    return wrong_with_call(calls[seed % calls.size()]);
  });
}

TEST(ProgramFuzz, NoDamagedFileUpsetsAPlan) {
  auto plan = app::testing::example_plan("09_axle_points_file");
  plan["features"][0]["source"]["file"] = "points.csv";
  // The trials of damaged touches are run by JournalFuzz, without a process for each.
  if (std::getenv("RONDURE_FULL") == nullptr) app::testing::leave_out_intervals(plan);
  const fs::path folder = work_folder() / "program-plan";
  const TableMutation rows(
      {app::testing::read(app::testing::source_dir() / "tests/data/axle_mzc_3/points.csv")});
  try_cases({12, 700}, [&](unsigned seed) {
    fs::remove_all(folder);
    fs::create_directory(folder);
    app::testing::write(folder / "plan.json", plan.dump());
    app::testing::write(folder / "points.csv", rows.input(seed));
    return wrong_with_call({"run", (folder / "plan.json").string(), "--out",
                            (folder / "run").string(), "--format", "json,csv", "--archive",
                            "none"});
  });
}

/// A file of an analysis, and the words of the command that reads it.
struct SeriesDoor {
  std::vector<std::string> tables;
  std::vector<std::string> before;  ///< The file.
  std::vector<std::string> behind = {};
};

TEST(ProgramFuzz, NoDamagedSeriesUpsetsAnAnalysis) {
  const auto kept = [](const char* name, const std::string& text) {
    app::testing::write(work_folder() / name, text);
    return (work_folder() / name).string();
  };
  const std::string axes = kept("axes.csv", contour_tables().at(0));
  const std::string pin = kept("pin.csv", contour_tables().at(1));
  const std::vector<SeriesDoor> doors = {
      {wheel_tables(),
       {"fit", "wheel"},
       {"--set", "mode=indexed", "--set", "axis_x_mm=12.02", "--set", "axis_z_mm=-7", "--set",
        "uncertainty.point_um=0.4"}},
      {spindle_tables(),
       {"fit", "spindle"},
       {"--set", "layout=reference", "--set", "samples=128", "--set", "highest_order=20",
        "--json"}},
      {contour_tables(), {"fit", "contour", "--set", "samples=360", "--pin", pin, "--axes"}},
      {contour_tables(), {"fit", "contour", "--json", "--axes", axes, "--pin"}}};
  try_cases({16, 700}, [&](unsigned seed) {
    const SeriesDoor& door = doors[seed % doors.size()];
    const TableMutation rows(door.tables);
    std::vector<std::string> words = door.before;
    words.push_back(kept("damaged.csv", rows.input(seed)));
    words.insert(words.end(), door.behind.begin(), door.behind.end());
    return wrong_with_call(words);
  });
}

}  // namespace
}  // namespace rondure::fuzz
