#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// The bytes of a file, or kFile with the system's reason, also for a pipe or a device: those may
/// never begin or never end.
[[nodiscard]] core::Result<std::string> read_file(const std::filesystem::path& path);

/// Writes a file whole or not at all (temporary name in the same folder, flush to disk, rename);
/// kFile otherwise, and then nothing is left behind and an older file stays as it was.
[[nodiscard]] core::Result<void> write_file(const std::filesystem::path& path,
                                            std::string_view bytes);

/// Removes what a killed write_file() left in a folder.
void remove_temporaries(const std::filesystem::path& directory);

/// Flushes a folder's list of names to disk, so that a new file survives a power cut; kFile.
[[nodiscard]] core::Result<void> sync_directory(const std::filesystem::path& directory);

/// Words for an error number of the system: "the disk is full (No space left on device)".
[[nodiscard]] std::string system_reason(int error_number);

}  // namespace rondure::record
