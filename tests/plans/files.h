#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "plans/plan.h"
#include "record/points_csv.h"

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

/// The plans of a folder, by name.
inline std::vector<std::filesystem::path> plans_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// One line a problem; empty when there is a plan.
inline std::string lines_of(const PlanOrProblems& result) {
  std::string out;
  if (result) return out;
  for (const core::Error& problem : result.error()) out += core::to_line(problem) + "\n";
  return out;
}

}  // namespace rondure::plans::testing
