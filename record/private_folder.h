#pragma once

#include <filesystem>

namespace rondure::record {

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
