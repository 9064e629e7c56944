#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace rondure::fuzz {

/// Changes some rows of a SQLite file: values of every type and size, names of other rows, rows
/// removed, doubled and renumbered. Changes that the tables themselves refuse are skipped.
void damage_rows(const std::filesystem::path& file, const std::vector<std::string>& tables,
                 std::mt19937& random);

/// Writes the links, digests and SHA256SUMS that the rows of a journal would have had, whatever
/// they are now: whoever can write into a run directory can do this.
void reseal(const std::filesystem::path& directory);

}  // namespace rondure::fuzz
