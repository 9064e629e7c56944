#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "record/run_record.h"
#include "tests/app/program.h"

namespace rondure::app::testing {

[[nodiscard]] std::filesystem::path source_dir();
[[nodiscard]] std::filesystem::path example(const std::string& name);
/// Plans of a folder, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> plans_in(const std::filesystem::path& folder);

/// Whether the machine of a plan is reached through a socket, so that the test must serve it.
[[nodiscard]] bool needs_server(const std::filesystem::path& plan);

/// Bytes of a file; empty when there is none.
[[nodiscard]] std::string read(const std::filesystem::path& file);
void write(const std::filesystem::path& file, std::string_view bytes);
/// Names in a folder, sorted; empty when there is no folder.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder);

/// Replaces the first `from` in a file by `to`. The file must hold `from`.
void replace_in(const std::filesystem::path& file, const std::string& from, const std::string& to);

/// One changed value of the first example plan: JSON pointer and new value.
struct Change {
  std::string pointer;
  nlohmann::json value;
};
/// Writes the first example plan with these changes, judged by simple acceptance: its runs have no
/// intervals, whose trials take nearly all of their time.
void write_plan(const std::filesystem::path& file, const std::vector<Change>& changes);
/// The same with the influences and the decision rule of the example, for tests of intervals.
void write_plan_with_intervals(const std::filesystem::path& file,
                               const std::vector<Change>& changes);

/// An example plan ("09_axle_points_file") that can be written to any place: the files that it
/// names have absolute paths.
[[nodiscard]] nlohmann::ordered_json example_plan(const std::string& name);
/// The example of the crank pins with two pins in place of four and every fourth angle: its
/// intervals take a quarter of the time.
[[nodiscard]] nlohmann::ordered_json two_crank_pins();

/// The wheel of example 06 before it was dressed: a proud grain at one of sixteen points.
[[nodiscard]] nlohmann::ordered_json wheel_with_a_grain();
/// Takes the declared influences out of a plan of surfaces, which then is judged by simple
/// acceptance. `Json` is nlohmann::json or nlohmann::ordered_json.
template <class Json>
void leave_out_intervals(Json& plan) {
  if (plan.erase("uncertainty") > 0) plan["decision_rule"] = {{"rule", "simple-acceptance"}};
}

/// The folder with finished runs of all examples that need no server, one by the name of each
/// ("09_axle_points_file"), with every format that needs no browser. They are made once a pass of
/// ctest (run_examples.sh), in a test program that is started by hand at the first call; to be read
/// only.
[[nodiscard]] std::filesystem::path example_runs();
/// How the run of an example ended, and what it printed.
[[nodiscard]] Outcome example_outcome(const std::string& name);
/// `rondure run` of an example without its intervals; `words` follow the plan.
Outcome run_without_intervals(const std::string& name, const std::vector<std::string>& words,
                              const Surroundings& surroundings = {});

/// The contents of a journal; fails the test when it cannot be read.
[[nodiscard]] record::RunRecord journal_of(const std::filesystem::path& run);

/// Writes a record as the journal of a finished run, with a matching chain, seal and SHA256SUMS.
void write_resealed(const record::RunRecord& run, const std::filesystem::path& directory);

/// Output of `rondure history --json` for an archive; fails the test when it ends with an error.
[[nodiscard]] nlohmann::json history_of(const std::filesystem::path& archive,
                                        const std::vector<std::string>& more = {});

}  // namespace rondure::app::testing
