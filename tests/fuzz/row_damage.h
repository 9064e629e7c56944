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

}  // namespace rondure::fuzz
