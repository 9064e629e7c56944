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
/// Writes the first example plan with these changes.
void write_plan(const std::filesystem::path& file, const std::vector<Change>& changes);

/// The contents of a journal; fails the test when it cannot be read.
[[nodiscard]] record::RunRecord journal_of(const std::filesystem::path& run);

/// Writes a record as the journal of a finished run, with a matching chain, seal and SHA256SUMS.
void write_resealed(const record::RunRecord& run, const std::filesystem::path& directory);

/// Output of `rondure history --json` for an archive; fails the test when it ends with an error.
[[nodiscard]] nlohmann::json history_of(const std::filesystem::path& archive,
                                        const std::vector<std::string>& more = {});

}  // namespace rondure::app::testing
