#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace rondure::app {

/// A plan that a command line states, and what is done with it.
struct PlanInMemory {
  std::string name;  ///< Where a file would be named: "fit wheel".
  /// The plan for a folder, from which it names its files; empty: the current one.
  std::function<std::string(const std::filesystem::path& folder)> text;
  /// What the person calls a place of the plan, given as JSON pointer.
  std::function<std::string(const std::string& pointer)> place_name;
  /// What the plan spells of the command line: an option each, with its words.
  std::vector<std::pair<const char*, std::string>> words;
  std::string out;        ///< Run directory; empty: no run that stays.
  std::string save_plan;  ///< File for the plan; empty: none.
  std::string serial;
  std::string operator_name;
};

/// A file of the command line as a plan in this folder names it; empty: the current folder.
[[nodiscard]] std::string file_from(const std::string& file, const std::filesystem::path& folder);

/// Checks that a plan can spell the words: JSON is UTF-8. kBadOption names the option.
[[nodiscard]] core::Result<void> check_spelling(const PlanInMemory& plan);

/// Writes the plan where it has a `save_plan`, and runs it where it has an `out`, to a page and a
/// journal that `verify` and `sign` take like any other.
/// @pre     It has one of both.
/// @return  Exit status of the program.
[[nodiscard]] int save_or_run(const PlanInMemory& plan);

/// Runs the plan in a folder that goes away, and prints the summary of the run, or its report.json.
/// @return  Exit status of the program.
[[nodiscard]] int run_in_passing(const PlanInMemory& plan, bool json);

}  // namespace rondure::app
