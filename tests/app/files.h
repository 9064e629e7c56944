#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "record/run_record.h"

namespace rondure::app::testing {

[[nodiscard]] std::filesystem::path source_dir();
[[nodiscard]] std::filesystem::path example(const std::string& name);
/// Plans of a folder, by name.
[[nodiscard]] std::vector<std::filesystem::path> plans_in(const std::filesystem::path& folder);

/// Whether the machine of a plan stands behind a socket: somebody has to serve it.
[[nodiscard]] bool needs_server(const std::filesystem::path& plan);

/// Bytes of a file; empty when there is none.
[[nodiscard]] std::string read(const std::filesystem::path& file);
void write(const std::filesystem::path& file, std::string_view bytes);
/// Names in a folder, sorted; empty when there is no folder.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder);

/// Puts `to` in place of the first `from` of a file, which must hold it.
void replace_in(const std::filesystem::path& file, const std::string& from, const std::string& to);

/// The first example plan with other values: JSON pointer and value each.
struct Change {
  std::string pointer;
  nlohmann::json value;
};
void write_plan(const std::filesystem::path& file, const std::vector<Change>& changes);

/// The contents of a journal; fails the test when it cannot be read.
[[nodiscard]] record::RunRecord journal_of(const std::filesystem::path& run);

/// Writes a record as the journal of a finished run, with a chain, a seal and a list that fit it.
void write_resealed(const record::RunRecord& run, const std::filesystem::path& directory);

/// What `rondure history --json` says of an archive; fails the test when it ends with an error.
[[nodiscard]] nlohmann::json history_of(const std::filesystem::path& archive,
                                        const std::vector<std::string>& more = {});

}  // namespace rondure::app::testing
