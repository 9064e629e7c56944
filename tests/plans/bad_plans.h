#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/app/files.h"

namespace rondure::plans::testing {

/// A plan with faults of one kind.
struct BadPlan {
  std::string file;  ///< Its name in places and above the approved sentences.
  std::string text;
  std::vector<std::string> problems;  ///< Code and place of each, in order: "rank /features/0".
};

/// Folder of the table. Bases, points files and calibrations are named relative to it.
inline std::filesystem::path bad_plans_folder() {
  return app::testing::source_dir() / "tests/data/bad_plans";
}

/// The rows of bad_plans.json: each a `base`, which is a good plan, with a JSON patch (RFC 6902),
/// or a `text`, or a `file` with bytes that JSON cannot hold.
inline std::vector<BadPlan> bad_plans() {
  const auto read = [](const std::string& file) {
    return app::testing::read(bad_plans_folder() / file);
  };
  std::vector<BadPlan> out;
  for (const auto& row : nlohmann::ordered_json::parse(read("bad_plans.json"))) {
    std::string text = row.value("text", "");
    if (row.contains("file")) text = read(row.at("file"));
    if (row.contains("base")) {
      text = nlohmann::ordered_json::parse(read(row.at("base"))).patch(row.at("patch")).dump(2);
    }
    out.push_back({row.at("name").get<std::string>() + ".json", text, row.at("problems")});
  }
  return out;
}

}  // namespace rondure::plans::testing
