#pragma once

#include <filesystem>

#include "core/result.h"

namespace rondure::record {

/// Whether a directory holds nothing of a run yet: it is absent, empty, or holds a journal without
/// tables whose creation was interrupted. Such a journal is removed, so that the run can begin
/// there.
/// @return  false for everything else; kFile when another process uses the directory or it cannot
///          be read.
[[nodiscard]] core::Result<bool> clear_unborn_run(const std::filesystem::path& directory);

}  // namespace rondure::record
