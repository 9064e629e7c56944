#include "tests/fuzz/run_samples.h"

#include <array>
#include <functional>
#include <random>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "record/journal/internal/schema.h"
#include "record/journal/journal.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/row_damage.h"

namespace rondure::fuzz {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Fewer touches, trials and rows, where a plan has many.
void shorten(Json& plan) {
  const std::array<std::pair<const char*, int>, 13> least = {{{"layers", 2},
                                                              {"points_per_layer", 6},
                                                              {"max_poses", 2},
                                                              {"repeats", 2},
                                                              {"turns", 2},
                                                              {"samples_per_turn", 128},
                                                              {"samples", 128},
                                                              {"highest_order", 10},
                                                              {"most_trials", 2000},
                                                              {"budget_trials", 100},
                                                              {"cutoff_upr", 10},
                                                              {"parts", 2},
                                                              {"gauge_points", 360}}};
  for (auto& [key, value] : plan.items()) {
    if (value.is_structured()) shorten(value);
    for (const auto& [name, number] : least) {
      if (key == name && value.is_number() && value > number) value = number;
    }
  }
}

fs::path run_of(const std::string& name, bool short_plan) {
  Json plan = app::testing::example_plan(name);
  if (short_plan) shorten(plan);
  const fs::path file = work_folder() / (name + ".json");
  app::testing::write(file, plan.dump());
  const fs::path out = work_folder() / name;
  const auto outcome = app::testing::rondure(
      {"run", file.string(), "--out", out.string(), "--format", "json", "--archive", "none"});
  if (outcome.status != 0 && outcome.status != 1) throw std::runtime_error(name + outcome.err);
  return out;
}

}  // namespace

const fs::path& spool_run() {
  static const fs::path run = run_of("01_spool_simulated", true);
  return run;
}

const std::vector<fs::path>& sample_runs() {
  static const std::vector<fs::path> runs = [] {
    std::vector<fs::path> out = {spool_run()};
    for (const char* name :
         {"03_inspect_calibrated", "04_part_in_two_poses", "05_spindle_three_probe", "06_wheel",
          "07_crank_pin", "09_axle_points_file"}) {
      out.push_back(run_of(name, true));
    }
    out.push_back(run_of("03_calibrate_fixture", false));
    return out;
  }();
  return runs;
}

void write_resealed_run(const fs::path& directory, unsigned seed) {
  std::mt19937 random(seed);
  const auto& runs = sample_runs();
  fs::remove_all(directory);
  fs::create_directory(directory);
  const fs::path file = directory / record::kJournalName;
  fs::copy_file(runs[random() % runs.size()] / record::kJournalName, file);
  // What was measured; what was asked of it is held against the plan, and goes no further.
  std::vector<std::string> tables = {"pose",   "touch",        "touch",         "decision",
                                     "series", "series_block", "series_column", "truth_value"};
  if (seed % 8 == 0) {
    tables.clear();
    for (const record::Table& table : record::chained_tables()) tables.emplace_back(table.name);
  }
  damage_rows(file, tables, random);
  reseal(directory);
}

}  // namespace rondure::fuzz
