#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Name of the lock in a run directory.
inline constexpr std::string_view kLockName = "run.lock";

/// One process a run directory. The lock belongs to the open file (flock), so the system gives it
/// back when its process dies, however it dies: a file that a killed run left behind locks nothing.
/// The file says which process on which host holds it.
class RunLock {
 public:
  /// Takes the lock of a directory that exists, without waiting. kFile when another process holds
  /// it (`what` names its pid and host), when the file cannot be made, or when something else
  /// stands in its place (a link, a pipe, a file of the user), which is left as it is.
  [[nodiscard]] static core::Result<RunLock> take(const std::filesystem::path& directory);

  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  ~RunLock();  ///< Removes the file, then gives the lock back.

 private:
  RunLock(std::filesystem::path file, int fd);

  std::filesystem::path file_;
  int fd_ = -1;
};

}  // namespace rondure::record
