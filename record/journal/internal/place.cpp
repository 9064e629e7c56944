#include "record/journal/internal/place.h"

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "record/files.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

core::Result<void> make_directory(const fs::path& directory, Undo& undo) {
  std::vector<fs::path> missing;
  std::error_code problem;
  for (fs::path path = directory;
       !fs::exists(path, problem) && !problem && path.has_relative_path();
       path = path.parent_path()) {
    missing.push_back(path);
  }
  for (auto path = missing.rbegin(); path != missing.rend() && !problem; ++path) {
    if (fs::create_directory(*path, problem)) undo.made.push_back(*path);
  }
  if (problem) {
    return core::fail(core::Code::kFile,
                      fmt::format("the run directory {} cannot be made: {}", directory.string(),
                                  system_reason(problem.value())),
                      directory.string());
  }
  return {};
}

core::Result<void> require_empty_directory(const fs::path& directory) {
  std::error_code problem;
  fs::directory_iterator entry(directory, problem);
  if (problem) {
    return core::fail(
        core::Code::kFile,
        problem.value() == ENOTDIR
            ? fmt::format("{} is a file; name a new directory for this run", directory.string())
            : fmt::format("the run directory {} cannot be looked at: {}", directory.string(),
                          system_reason(problem.value())),
        directory.string());
  }
  const fs::directory_iterator end;
  if (entry != end && entry->path().filename() == kLockName) entry.increment(problem);
  if (entry == end) return {};
  return core::fail(core::Code::kFile,
                    fmt::format("{} is not empty (it holds {}); name a new directory for this run",
                                directory.string(), entry->path().filename().string()),
                    directory.string());
}

}  // namespace

Undo::~Undo() {
  std::error_code ignored;  // a folder that another program has filled is kept
  for (auto path = made.rbegin(); path != made.rend(); ++path) fs::remove(*path, ignored);
}

core::Result<RunLock> lock_new_directory(const fs::path& directory, Undo& undo) {
  if (auto made = make_directory(directory, undo); !made) return core::fail(made.error());
  // A new lock is created only in an empty directory; an existing one names its holder.
  std::error_code ignored;
  if (!fs::exists(directory / kLockName, ignored)) {
    if (auto empty = require_empty_directory(directory); !empty) return core::fail(empty.error());
  }
  auto lock = RunLock::take(directory);
  if (!lock) return lock;
  if (auto empty = require_empty_directory(directory); !empty) return core::fail(empty.error());
  return lock;
}

core::Result<void> make_empty_journal(const fs::path& file, Undo& undo) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) {
    return core::fail(
        core::Code::kFile,
        fmt::format("the journal {} cannot be made: {}", file.string(), system_reason(errno)),
        file.string());
  }
  ::close(fd);
  for (const char* suffix : {"-shm", "-wal", "-journal", ""}) {
    undo.made.emplace_back(file.string() + suffix);
  }
  return {};
}

core::Result<void> sync_names(const Undo& undo) {
  for (const fs::path& path : undo.made) {
    if (auto synced = sync_directory(path.parent_path()); !synced) return synced;
  }
  return {};
}

}  // namespace rondure::record
