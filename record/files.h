#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

// Most bytes of a file that is read whole.
inline constexpr std::uintmax_t kMostDocumentBytes = std::uintmax_t{64} << 20;  ///< 64 MiB.
inline constexpr std::uintmax_t kMostPointsBytes = std::uintmax_t{4} << 30;     ///< 4 GiB.
inline constexpr std::uintmax_t kMostJournalBytes = std::uintmax_t{16} << 30;   ///< 16 GiB.

/// Returns the bytes of a file, or kFile with the system's reason. A pipe or a device is refused
/// too, because its data may never begin or never end.
/// @param most_bytes  A longer file is refused before anything of it is read.
[[nodiscard]] core::Result<std::string> read_file(const std::filesystem::path& path,
                                                  std::uintmax_t most_bytes = kMostDocumentBytes);

/// The SHA-256 of a file, as 64 lower-case hexadecimal digits; refuses what read_file() refuses.
/// Takes no memory for its bytes, so that it may be as long as a journal.
[[nodiscard]] core::Result<std::string> sha256_file(const std::filesystem::path& path);

/// Writes a file completely or not at all (temporary name in the same folder, flush to disk,
/// rename). On kFile no temporary file remains and an older file is unchanged.
[[nodiscard]] core::Result<void> write_file(const std::filesystem::path& path,
                                            std::string_view bytes);

// Files of a run directory, which may come from elsewhere. `name` is that of a file in it or in a
// folder of it, "corrections/pin-x-of-c.csv". The directory itself may be reached through links,
// but no file and no folder below it is: a link there could lead the program to files of somebody
// else. kFile says which name is a link.

/// read_file() below a directory.
[[nodiscard]] core::Result<std::string> read_inside(const std::filesystem::path& directory,
                                                    const std::filesystem::path& name,
                                                    std::uintmax_t most_bytes = kMostDocumentBytes);
/// sha256_file() below a directory.
[[nodiscard]] core::Result<std::string> sha256_inside(const std::filesystem::path& directory,
                                                      const std::filesystem::path& name);
/// write_file() below a directory; makes the folder where it is missing.
[[nodiscard]] core::Result<void> write_inside(const std::filesystem::path& directory,
                                              const std::filesystem::path& name,
                                              std::string_view bytes);
/// Removes a file below a directory; kFile also when there is none.
[[nodiscard]] core::Result<void> remove_inside(const std::filesystem::path& directory,
                                               const std::filesystem::path& name);

/// Removes the temporary files of a killed write_file() from a directory, or from a folder of it.
void remove_temporaries(const std::filesystem::path& directory,
                        const std::filesystem::path& folder = {});

/// A name as part of a file's name: letters, digits, dots, dashes and underscores, other characters
/// as underscores, at most 100 bytes. Different names can give the same one.
[[nodiscard]] std::string plain_name(std::string_view name);

/// Flushes a folder's directory entries to disk, so that a new file survives a power cut; kFile.
[[nodiscard]] core::Result<void> sync_directory(const std::filesystem::path& directory);

/// Words for an error number of the system: "the disk is full (No space left on device)".
[[nodiscard]] std::string system_reason(int error_number);

/// A folder of this process in TMPDIR, or in /tmp where that is none; it goes away, with what is in
/// it, when this does.
class PrivateFolder {
 public:
  /// @param name  Of the folder, before six letters.
  explicit PrivateFolder(const char* name);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  /// Empty when the folder cannot be created (errno).
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace rondure::record
