#pragma once

#include <stdlib.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace rondure::test {

/// A new folder of its own, removed with everything in it at the end. Tests run beside each other:
/// a folder whose name is fixed would be shared by two of them
/// (`Tests.MakeTheirFoldersInOnePlace`).
class Scratch {
 public:
  enum class Where {
    kMemory,  ///< where memory_folder() is one: journals wait for a disk at every touch
    kDisk,    ///< for what is about the disk: what a killed program leaves, what a flush costs
  };

  explicit Scratch(Where where = Where::kMemory) {
    const std::filesystem::path memory = memory_folder();
    std::string name =
        ((where == Where::kMemory && !memory.empty() ? memory
                                                     : std::filesystem::temp_directory_path()) /
         "rondure test XXXXXX")
            .string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  /// Names of the files in it and below it, sorted.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
      names.push_back(entry.path().lexically_relative(path_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  /// A file system in memory that has room and lets programs start; empty where there is none, or
  /// where TMPDIR names the place.
  [[nodiscard]] static std::filesystem::path memory_folder() {
    constexpr double kRoom = 1e9;  // bytes; a container may give 64 MB
    const char* const folder = "/dev/shm";
    struct statvfs found = {};
    const bool good =
        ::getenv("TMPDIR") == nullptr && ::statvfs(folder, &found) == 0 &&
        (found.f_flag & (ST_RDONLY | ST_NOEXEC)) == 0 &&
        static_cast<double>(found.f_bavail) * static_cast<double>(found.f_frsize) >= kRoom;
    return good ? folder : "";
  }

 private:
  std::filesystem::path path_;
};

}  // namespace rondure::test
