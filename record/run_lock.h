#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Name of the lock in a run directory.
inline constexpr std::string_view kLockName = "run.lock";

/// Allows one process per run directory. The lock belongs to the open file (flock), so that the
/// system releases it whenever the process ends: a file left by a killed run locks nothing. The
/// file names the process and the host that hold the lock.
class RunLock {
 public:
  /// Locks an existing directory without waiting. kFile when another process holds the lock (`what`
  /// names its pid and host), when the file cannot be created, or when something else has that name
  /// (a link, a pipe, a user's file), which is not changed.
  [[nodiscard]] static core::Result<RunLock> take(const std::filesystem::path& directory);

  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  ~RunLock();  ///< Removes the file, then releases the lock.

 private:
  RunLock(std::filesystem::path file, int fd);

  std::filesystem::path file_;
  int fd_ = -1;
};

}  // namespace rondure::record
