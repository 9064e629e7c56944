#include "record/files.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// An open file descriptor, closed at the end of its scope.
class OpenFile {
 public:
  OpenFile(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~OpenFile() { close(); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] bool ok() const { return fd_ >= 0; }
  [[nodiscard]] int fd() const { return fd_; }
  /// False when the system could not store the data (network disks report this only on close).
  bool close() { return fd_ < 0 || ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

tl::unexpected<core::Error> cannot(std::string_view verb, const fs::path& path,
                                   std::string_view reason) {
  return core::fail(core::Code::kFile, fmt::format("cannot {} {}: {}", verb, path.string(), reason),
                    path.string());
}

tl::unexpected<core::Error> cannot(std::string_view verb, const fs::path& path, int error_number) {
  return cannot(verb, path, system_reason(error_number));
}

/// Writes all bytes and flushes them to the disk; when false, errno has the reason.
bool write_through(OpenFile& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file.fd(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return ::fsync(file.fd()) == 0 && file.close();
}

constexpr std::string_view kTemporaryPrefix = ".rondure-";
constexpr std::string_view kTemporarySuffix = ".tmp";

/// A name in the folder of `path` that cannot be predicted and that no leftover file has. Process
/// numbers repeat: in a container every program is number 1.
fs::path temporary_name(const fs::path& path) {
  std::uint64_t number = 0;
  while (::getrandom(&number, sizeof number, 0) < 0 && errno == EINTR) {
  }
  return path.parent_path() /
         fmt::format("{}{:016x}{}", kTemporaryPrefix, number, kTemporarySuffix);
}

}  // namespace

std::string system_reason(int error_number) {
  const std::string system = std::generic_category().message(error_number);
  switch (error_number) {
    case ENOENT:
      return "there is no such file or folder";
    case ENOTDIR:
      return "a part of its path is a file, not a folder";
    case EISDIR:
      return "it is a folder, a file is expected";
    case EACCES:
    case EPERM:
      return fmt::format("this user is not allowed to ({}); change the permissions", system);
    case EROFS:
      return fmt::format("the disk is read-only ({}); choose another folder", system);
    case ENOSPC:
    case EDQUOT:
      return fmt::format("the disk is full ({}); free space on the disk", system);
    case EFBIG:
      return fmt::format("it would exceed the largest file allowed here ({}); raise the limit",
                         system);
    default:
      return system;
  }
}

core::Result<std::string> read_file(const fs::path& path) {
  // Opened without waiting: a pipe without a writer would block the program forever.
  const OpenFile file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (!file.ok()) return cannot("read", path, errno);
  struct stat status = {};
  if (::fstat(file.fd(), &status) != 0) return cannot("read", path, errno);
  if (S_ISDIR(status.st_mode)) return cannot("read", path, EISDIR);
  if (!S_ISREG(status.st_mode)) {
    return cannot("read", path, "it is a device or a pipe; name a file");
  }
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(status.st_size) + 1);
  std::array<char, 1 << 16>
      piece;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  while (true) {
    const ssize_t count = ::read(file.fd(), piece.data(), piece.size());
    if (count == 0) return bytes;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot("read", path, errno);
    bytes.append(piece.data(), static_cast<std::size_t>(count));
  }
}

core::Result<void> sync_directory(const fs::path& directory) {
  const fs::path name = directory.empty() ? fs::path(".") : directory;
  const OpenFile folder(name, O_RDONLY | O_DIRECTORY);
  if (!folder.ok()) return cannot("flush the folder", name, errno);
  // EINVAL comes from file systems on which a folder needs no flush.
  if (::fsync(folder.fd()) != 0 && errno != EINVAL) return cannot("flush the folder", name, errno);
  return {};
}

void remove_temporaries(const fs::path& directory) {
  std::error_code ignored;  // a file that cannot be removed does no harm
  for (const auto& entry : fs::directory_iterator(directory, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kTemporaryPrefix) && name.ends_with(kTemporarySuffix)) {
      fs::remove(entry.path(), ignored);
    }
  }
}

core::Result<void> write_file(const fs::path& path, std::string_view bytes) {
  std::error_code ignored;  // an error here occurs again below, with its reason
  if (fs::is_directory(path, ignored)) return cannot("write", path, EISDIR);
  const fs::file_status there = fs::status(path, ignored);
  if (fs::exists(there) && !fs::is_regular_file(there)) {  // a file would replace it
    return cannot("write", path, "it is a device or a pipe; name a file");
  }
  const fs::path temporary = temporary_name(path);
  OpenFile file(temporary, O_WRONLY | O_CREAT | O_EXCL);
  if (!file.ok()) return cannot("write", path, errno);
  if (!write_through(file, bytes) || ::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    return cannot("write", path, reason);
  }
  return sync_directory(path.parent_path());
}

}  // namespace rondure::record
