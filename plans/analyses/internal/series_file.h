#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "record/files.h"

namespace rondure::plans {

/// Reads a file named in a plan; an error uses the name in the plan.
/// @return kFile when it does not exist, is not a file, or is longer than `most_bytes`.
[[nodiscard]] core::Result<std::string> read_data_file(
    const std::filesystem::path& path, const std::string& file,
    std::uintmax_t most_bytes = record::kMostPointsBytes);

}  // namespace rondure::plans
