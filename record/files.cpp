#include "record/files.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// An open file descriptor, closed at the end of its scope.
class OpenFile {
 public:
  /// @param folder  Descriptor of the folder that a relative path begins in.
  OpenFile(const fs::path& path, int flags, int folder = AT_FDCWD)
      : fd_(::openat(folder, path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~OpenFile() { close(); }
  OpenFile(OpenFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

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

/// A name that cannot be predicted and that no leftover file has. Process numbers repeat: in a
/// container every program is number 1.
std::string temporary_name() {
  std::uint64_t number = 0;
  while (::getrandom(&number, sizeof number, 0) < 0 && errno == EINTR) {
  }
  return fmt::format("{}{:016x}{}", kTemporaryPrefix, number, kTemporarySuffix);
}

/// Opens a folder below a directory, no link followed on the way.
/// @param verb  What is done there, for messages.
/// @param make  Makes the folder where it is missing.
core::Result<OpenFile> open_folder(std::string_view verb, const fs::path& directory,
                                   const fs::path& folder, bool make = false) {
  OpenFile at(directory.empty() ? fs::path(".") : directory, O_RDONLY | O_DIRECTORY);
  if (!at.ok()) return cannot(verb, directory, errno);
  fs::path reached = directory;
  for (const fs::path& step : folder) {
    reached /= step;
    if (step == ".." || step.is_absolute())
      return cannot(verb, reached, "it lies outside of the directory");
    if (make && ::mkdirat(at.fd(), step.c_str(), 0777) != 0 && errno != EEXIST)
      return cannot(verb, reached, errno);
    OpenFile next(step, O_RDONLY | O_DIRECTORY | O_NOFOLLOW, at.fd());
    if (!next.ok() && (errno == ENOTDIR || errno == ELOOP)) {
      return cannot(verb, reached,
                    "it is a link or a file, not a folder of this run; move it away");
    }
    if (!next.ok()) return cannot(verb, reached, errno);
    at = std::move(next);
  }
  return at;
}

/// Reads a file in pieces.
/// @param take  Called with each piece, and with the length that the file has now.
template <class Take>
core::Result<void> read_pieces(const OpenFile& file, const fs::path& path,
                               std::uintmax_t most_bytes, const Take& take) {
  if (!file.ok()) return cannot("read", path, errno);
  struct stat status = {};
  if (::fstat(file.fd(), &status) != 0) return cannot("read", path, errno);
  if (S_ISDIR(status.st_mode)) return cannot("read", path, EISDIR);
  if (!S_ISREG(status.st_mode)) {
    return cannot("read", path, "it is a device or a pipe; name a file");
  }
  const auto length = static_cast<std::uintmax_t>(status.st_size);
  std::uintmax_t bytes = length;
  std::array<char, 1 << 16>
      piece;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (std::uintmax_t taken = 0; bytes <= most_bytes; bytes = std::max(length, taken)) {
    const ssize_t count = ::read(file.fd(), piece.data(), piece.size());
    if (count == 0) return {};
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot("read", path, errno);
    take(std::string_view(piece.data(), static_cast<std::size_t>(count)), length);
    taken += static_cast<std::uintmax_t>(count);  // it may grow while it is read
  }
  return cannot("read", path,
                fmt::format("it has {} bytes, the limit for such a file is {}", bytes, most_bytes));
}

core::Result<std::string> read_open(const OpenFile& file, const fs::path& path,
                                    std::uintmax_t most_bytes) {
  std::string bytes;
  TRY_DO(read_pieces(file, path, most_bytes, [&](std::string_view piece, auto length) {
    if (bytes.empty()) bytes.reserve(static_cast<std::size_t>(length) + 1);
    bytes += piece;
  }));
  return bytes;
}

core::Result<std::string> sha256_open(const OpenFile& file, const fs::path& path) {
  Sha256 hash;
  TRY_DO(read_pieces(file, path, kMostJournalBytes,
                     [&](std::string_view piece, auto) { hash.add(piece); }));
  return hash.hex();
}

// Opened without waiting: a pipe without a writer would block the program forever.
constexpr int kReadFlags = O_RDONLY | O_NONBLOCK | O_NOCTTY;

/// Opens a file below a directory, no link followed on the way.
core::Result<OpenFile> open_inside(const fs::path& directory, const fs::path& name) {
  TRY(const auto folder, open_folder("read", directory, name.parent_path()));
  OpenFile file(name.filename(), kReadFlags | O_NOFOLLOW, folder.fd());
  if (file.ok()) return file;
  if (errno == ELOOP) {
    return cannot("read", directory / name,
                  "it is a link, not a file of this run; put the file itself there");
  }
  return cannot("read", directory / name, errno);
}

/// Writes a file whole into an open folder.
/// @param path  Of the file, for messages.
core::Result<void> write_at(const OpenFile& folder, const fs::path& path, std::string_view bytes) {
  const fs::path name = path.filename();
  if (name.empty()) return cannot("write", path, EISDIR);
  struct stat there = {};
  if (::fstatat(folder.fd(), name.c_str(), &there, 0) == 0) {
    if (S_ISDIR(there.st_mode)) return cannot("write", path, EISDIR);
    if (!S_ISREG(there.st_mode)) {  // a file would replace it
      return cannot("write", path, "it is a device or a pipe; name a file");
    }
  }
  const std::string temporary = temporary_name();
  OpenFile file(temporary, O_WRONLY | O_CREAT | O_EXCL, folder.fd());
  if (!file.ok()) return cannot("write", path, errno);
  if (!write_through(file, bytes) ||
      ::renameat(folder.fd(), temporary.c_str(), folder.fd(), name.c_str()) != 0) {
    const int reason = errno;
    ::unlinkat(folder.fd(), temporary.c_str(), 0);
    return cannot("write", path, reason);
  }
  // EINVAL comes from file systems on which a folder needs no flush.
  if (::fsync(folder.fd()) != 0 && errno != EINVAL)
    return cannot("flush the folder", path.parent_path(), errno);
  return {};
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

core::Result<std::string> read_file(const fs::path& path, std::uintmax_t most_bytes) {
  return read_open(OpenFile(path, kReadFlags), path, most_bytes);
}

core::Result<std::string> read_inside(const fs::path& directory, const fs::path& name,
                                      std::uintmax_t most_bytes) {
  TRY(const auto file, open_inside(directory, name));
  return read_open(file, directory / name, most_bytes);
}

core::Result<std::string> sha256_file(const fs::path& path) {
  return sha256_open(OpenFile(path, kReadFlags), path);
}

core::Result<std::string> sha256_inside(const fs::path& directory, const fs::path& name) {
  TRY(const auto file, open_inside(directory, name));
  return sha256_open(file, directory / name);
}

core::Result<void> sync_directory(const fs::path& directory) {
  const fs::path name = directory.empty() ? fs::path(".") : directory;
  const OpenFile folder(name, O_RDONLY | O_DIRECTORY);
  if (!folder.ok()) return cannot("flush the folder", name, errno);
  // EINVAL comes from file systems on which a folder needs no flush.
  if (::fsync(folder.fd()) != 0 && errno != EINVAL) return cannot("flush the folder", name, errno);
  return {};
}

void remove_temporaries(const fs::path& directory, const fs::path& folder) {
  const auto at = open_folder("clear", directory, folder);
  if (!at) return;  // a file that cannot be removed does no harm
  std::error_code ignored;
  // The folder that was opened, whatever its name leads to by now.
  for (const auto& entry :
       fs::directory_iterator(fmt::format("/proc/self/fd/{}", at->fd()), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kTemporaryPrefix) && name.ends_with(kTemporarySuffix)) {
      ::unlinkat(at->fd(), name.c_str(), 0);
    }
  }
}

core::Result<void> write_file(const fs::path& path, std::string_view bytes) {
  const OpenFile folder(path.has_parent_path() ? path.parent_path() : fs::path("."),
                        O_RDONLY | O_DIRECTORY);
  if (!folder.ok()) return cannot("write", path, errno);
  return write_at(folder, path, bytes);
}

core::Result<void> write_inside(const fs::path& directory, const fs::path& name,
                                std::string_view bytes) {
  TRY(const auto folder, open_folder("write", directory, name.parent_path(), true));
  return write_at(folder, directory / name, bytes);
}

core::Result<void> remove_inside(const fs::path& directory, const fs::path& name) {
  TRY(const auto folder, open_folder("remove", directory, name.parent_path()));
  if (::unlinkat(folder.fd(), name.filename().c_str(), 0) == 0) return {};
  return cannot("remove", directory / name, errno);
}

std::string plain_name(std::string_view name) {
  constexpr std::size_t kLongest = 100;
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.-_";
  std::string out(name.substr(0, kLongest));
  for (char& c : out) {
    if (kPlain.find(c) == std::string_view::npos) c = '_';
  }
  return out;
}

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder(const char* name) {
  std::error_code problem;
  const fs::path place = fs::temp_directory_path(problem);
  std::string made = ((problem ? fs::path("/tmp") : place) / name).string() + "-XXXXXX";
  if (::mkdtemp(made.data()) != nullptr) path_ = made;
}

PrivateFolder::~PrivateFolder() {
  if (path_.empty()) return;
  std::error_code problem;
  // A process that was just killed may still write a file into a folder that is being emptied.
  for (int i = 0; i < 5; ++i) {
    fs::remove_all(path_, problem);
    if (!problem) return;
    ::usleep(20'000);
  }
}

}  // namespace rondure::record
