#pragma once

#include <filesystem>

#include "core/result.h"

namespace rondure::record {

/// Whether nothing of a run has reached a directory yet: it is absent, empty, or holds a journal
/// without tables, whose making was interrupted. Such a remainder is removed, so that the run can
/// begin there.
/// @return  false for everything else; kFile when another process is at work in the directory, or
///          it cannot be looked at.
[[nodiscard]] core::Result<bool> clear_unstarted_run(const std::filesystem::path& directory);

}  // namespace rondure::record
