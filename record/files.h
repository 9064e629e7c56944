#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Returns the bytes of a file, or kFile with the system's reason. A pipe or a device is refused
/// too, because its data may never begin or never end.
[[nodiscard]] core::Result<std::string> read_file(const std::filesystem::path& path);

/// Writes a file completely or not at all (temporary name in the same folder, flush to disk,
/// rename). On kFile no temporary file remains and an older file is unchanged.
[[nodiscard]] core::Result<void> write_file(const std::filesystem::path& path,
                                            std::string_view bytes);

/// Removes the temporary files of a killed write_file() from a folder.
void remove_temporaries(const std::filesystem::path& directory);

/// Flushes a folder's directory entries to disk, so that a new file survives a power cut; kFile.
[[nodiscard]] core::Result<void> sync_directory(const std::filesystem::path& directory);

/// Words for an error number of the system: "the disk is full (No space left on device)".
[[nodiscard]] std::string system_reason(int error_number);

}  // namespace rondure::record
