#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "record/journal/journal.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {

namespace fs = std::filesystem;

namespace {

/// What run_examples.sh makes: folders `runs` and `told`.
fs::path made_examples() {
  const char* const made = std::getenv("RONDURE_EXAMPLE_RUNS");
  if (made != nullptr && std::string_view(made) == "none") {
    throw std::runtime_error(
        "this test reads the runs of the examples: name it in EXAMPLES of its CMakeLists.txt");
  }
  if (made != nullptr) return made;
  static const Scratch folder;
  static const int status = std::system(
      fmt::format("'{}' '{}' '{}' '{}'", (source_dir() / "tests/app/run_examples.sh").string(),
                  RONDURE_BINARY, source_dir().string(), (folder / "examples").string())
          .c_str());
  EXPECT_EQ(status, 0);
  return folder / "examples";
}

}  // namespace

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
  const Scratch folder;
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
