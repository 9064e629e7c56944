#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace rondure::plans {

/// The bytes of a file that a plan names; an error names it as the plan does.
/// @return kFile when it is not there, no file, or larger than 1 GB.
[[nodiscard]] core::Result<std::string> read_data_file(const std::filesystem::path& path,
                                                       const std::string& file);

}  // namespace rondure::plans
