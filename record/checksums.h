#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace rondure::record {

/// The list of digests in a run directory, as sha256sum writes and checks it:
/// `cd RUN_DIR && sha256sum -c SHA256SUMS`.
inline constexpr const char* kChecksumsName = "SHA256SUMS";

/// One line of the list.
struct Checksum {
  std::string file;    ///< A name in the same directory, or in a folder of it.
  std::string sha256;  ///< SHA-256 of the bytes: 64 lower-case hexadecimal digits.
};

/// Reads `directory`/SHA256SUMS. kFile when it cannot be read, kSyntax for a line that sha256sum
/// would not understand or that names a place outside the directory; `where` is "SHA256SUMS:3".
[[nodiscard]] core::Result<std::vector<Checksum>> read_checksums(
    const std::filesystem::path& directory);

/// Updates `directory`/SHA256SUMS: a line replaces that of the same file or is appended; other
/// lines stay, except those of the files in `gone`. Creates the list when there is none. Errors as
/// read_checksums(); kFile when it cannot be written.
[[nodiscard]] core::Result<void> update_checksums(const std::filesystem::path& directory,
                                                  const std::vector<Checksum>& files,
                                                  const std::vector<std::string>& gone = {});

}  // namespace rondure::record
