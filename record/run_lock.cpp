#include "record/run_lock.h"

#include <array>
#include <cerrno>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "record/files.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestHolder = 300;

/// "process 4711 on host lab3", as written by the holder; empty until then.
std::string holder_of(int fd) {
  std::array<char, kLongestHolder> text{};
  const ssize_t count = ::pread(fd, text.data(), text.size(), 0);
  const std::string holder(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return holder.substr(0, holder.find('\n'));
}

constexpr std::string_view kHolderBegins = "process ";

bool write_holder(int fd) {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host = {'?'};
  const std::string text = fmt::format("{}{} on host {}\n", kHolderBegins, ::getpid(), host.data());
  return ::ftruncate(fd, 0) == 0 &&
         ::pwrite(fd, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

/// Whether the name still refers to the open file: the last holder may have removed the file.
bool is_in_place(int fd, const fs::path& file) {
  struct stat opened = {};
  struct stat named = {};
  return ::fstat(fd, &opened) == 0 && ::lstat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Why an open file is not a lock, or nothing. A file with a second name (a hard link) is refused,
/// because emptying the lock would empty it too.
std::string_view why_no_lock(int fd) {
  struct stat opened = {};
  if (::fstat(fd, &opened) != 0 || !S_ISREG(opened.st_mode)) return "a pipe, a device or a folder";
  if (opened.st_nlink > 1) return "a second name of another file";
  const std::string holder = holder_of(fd);
  // After a power failure the file may be empty or contain zeros.
  const bool ours = holder.empty() || holder.front() == '\0' || holder.starts_with(kHolderBegins);
  return ours ? "" : "a file of something else";
}

tl::unexpected<core::Error> not_a_lock(const fs::path& file, std::string_view what) {
  return core::fail(
      core::Code::kFile,
      fmt::format("{} is {}, not the lock of a run; nothing was changed: move it away, or name "
                  "another run directory",
                  file.string(), what),
      file.string());
}

tl::unexpected<core::Error> cannot_lock(const fs::path& file, int error_number) {
  return core::fail(core::Code::kFile,
                    fmt::format("the lock {} of the run directory cannot be taken: {}",
                                file.string(), system_reason(error_number)),
                    file.string());
}

}  // namespace

core::Result<RunLock> RunLock::take(const fs::path& directory) {
  const fs::path file = directory / kLockName;
  while (true) {
    // A link is not followed, and a pipe or device does not block: only a lock is written to.
    const int fd = ::open(file.c_str(),
                          O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, 0666);
    if (fd < 0 && errno == ELOOP) return not_a_lock(file, "a link");
    if (fd < 0) return cannot_lock(file, errno);
    if (const std::string_view what = why_no_lock(fd); !what.empty()) {
      ::close(fd);
      return not_a_lock(file, what);
    }
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      const std::string holder = holder_of(fd);
      ::close(fd);
      if (reason != EWOULDBLOCK) return cannot_lock(file, reason);
      return core::fail(
          core::Code::kFile,
          fmt::format("the run directory {} is in use by {}; wait until it has "
                      "ended, stop it, or name another directory",
                      directory.string(), holder.empty() ? "another process" : holder),
          directory.string());
    }
    RunLock lock(file, fd);
    if (!is_in_place(fd, file)) {
      lock.file_.clear();  // belongs to another process
      continue;
    }
    if (!write_holder(fd)) return cannot_lock(file, errno);
    return lock;
  }
}

RunLock::RunLock(fs::path file, int fd) : file_(std::move(file)), fd_(fd) {}

RunLock::RunLock(RunLock&& other) noexcept
    : file_(std::exchange(other.file_, {})), fd_(std::exchange(other.fd_, -1)) {}

RunLock::~RunLock() {
  if (fd_ < 0) return;
  if (!file_.empty()) ::unlink(file_.c_str());
  ::close(fd_);
}

}  // namespace rondure::record
