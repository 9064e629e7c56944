#include "tests/app/files.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "record/journal/journal.h"

namespace rondure::app::testing {

namespace fs = std::filesystem;

namespace {

void write_changed(const fs::path& file, nlohmann::ordered_json plan,
                   const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    plan[nlohmann::ordered_json::json_pointer(change.pointer)] = change.value;
  }
  write(file, plan.dump(2));
}

/// What run_examples.sh makes: folders `runs` and `told`.
fs::path made_examples() {
  const char* const made = std::getenv("RONDURE_EXAMPLE_RUNS");
  if (made != nullptr) return made;
  static const TemporaryFolder folder;
  static const int status = std::system(
      fmt::format("'{}' '{}' '{}' '{}'", (source_dir() / "tests/app/run_examples.sh").string(),
                  RONDURE_BINARY, source_dir().string(), (folder / "examples").string())
          .c_str());
  EXPECT_EQ(status, 0);
  return folder / "examples";
}

}  // namespace

fs::path source_dir() { return RONDURE_SOURCE_DIR; }

fs::path example(const std::string& name) { return source_dir() / "plans" / "examples" / name; }

std::vector<fs::path> plans_in(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool needs_server(const fs::path& plan) {
  return nlohmann::json::parse(read(plan)).value("/machine/driver"_json_pointer, "") == "ippdme";
}

std::string read(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) {
    out.push_back(entry.path().filename().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string bytes = read(file);
  const std::size_t at = bytes.find(from);
  if (at == std::string::npos) throw std::runtime_error(file.string() + " does not hold " + from);
  write(file, bytes.replace(at, from.size(), to));
}

void write_plan(const fs::path& file, const std::vector<Change>& changes) {
  auto plan = example_plan("01_spool_simulated");
  leave_out_intervals(plan);
  write_changed(file, std::move(plan), changes);
}

void write_plan_with_intervals(const fs::path& file, const std::vector<Change>& changes) {
  write_changed(file, example_plan("01_spool_simulated"), changes);
}

nlohmann::ordered_json example_plan(const std::string& name) {
  auto plan = nlohmann::ordered_json::parse(read(example(name + ".json")));
  plan.erase("$schema");
  const auto from_anywhere = [](nlohmann::ordered_json& file) {
    file = example(file.get<std::string>()).string();
  };
  for (auto& feature : plan["features"]) {
    if (feature.contains("source")) from_anywhere(feature["source"]["file"]);
  }
  const nlohmann::ordered_json::json_pointer calibration("/fixture/calibration/file");
  if (plan.contains(calibration)) from_anywhere(plan[calibration]);
  return plan;
}

nlohmann::ordered_json two_crank_pins() {
  auto plan = example_plan("07_crank_pin");
  plan["simulation"]["contour"]["parts"] = 2;
  plan["simulation"]["contour"]["gauge_points"] = 360;
  return plan;
}

fs::path example_runs() { return made_examples() / "runs"; }

Outcome example_outcome(const std::string& name) {
  const fs::path told = made_examples() / "told";
  Outcome out;
  out.status = std::stoi(read(told / (name + ".status")));
  out.out = read(told / (name + ".out"));
  out.err = read(told / (name + ".err"));
  return out;
}

Outcome run_without_intervals(const std::string& name, const std::vector<std::string>& words,
                              const Surroundings& surroundings) {
  const TemporaryFolder folder;
  auto plan = example_plan(name);
  leave_out_intervals(plan);
  write(folder / (name + ".json"), plan.dump(2));
  std::vector<std::string> all = {"run", folder / (name + ".json")};
  all.insert(all.end(), words.begin(), words.end());
  return rondure(all, surroundings);
}

record::RunRecord journal_of(const fs::path& run) {
  auto read = record::read_journal(run);
  if (!read) {
    ADD_FAILURE() << core::to_line(read.error());
    return {};
  }
  EXPECT_TRUE(read->broken.empty());
  return std::move(read->record);
}

void write_resealed(const record::RunRecord& run, const fs::path& directory) {
  auto journal =
      record::Journal::create(directory, run.header, run.artefact, run.features, run.settings);
  ASSERT_TRUE(journal) << journal.error().what;
  for (const record::PoseVisit& pose : run.poses) ASSERT_TRUE(journal->add(pose));
  ASSERT_TRUE(journal->add(run.touches));
  for (const record::Decision& decision : run.decisions) ASSERT_TRUE(journal->add(decision));
  ASSERT_TRUE(journal->add(run.series, run.truth_values));
  ASSERT_TRUE(journal->end("finished", nullptr));
  ASSERT_TRUE(journal->seal(run.results));
}

nlohmann::json history_of(const fs::path& archive, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"history", archive, "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = rondure(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

}  // namespace rondure::app::testing
