#include "record/journal/internal/private_copy.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <span>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "record/files.h"
#include "record/journal/journal.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Changes whenever the log is moved into the file: file time and start of the log.
std::pair<fs::file_time_type, std::string> stamp_of(const fs::path& journal,
                                                    PrivateCopy::Logs logs) {
  std::error_code ignored;
  if (logs == PrivateCopy::Logs::kWithout) return {fs::last_write_time(journal, ignored), ""};
  constexpr std::size_t kLogHead = 32;
  std::array<char, kLogHead> head{};
  std::ifstream log(journal.string() + "-wal", std::ios::binary);
  log.read(head.data(), kLogHead);
  return {fs::last_write_time(journal, ignored), std::string(head.data(), kLogHead)};
}

/// Whether a rollback journal ends with the name of a super-journal (sqlite.org/fileformat2.html,
/// 3): a file anywhere on the disk that SQLite reads, and may delete. No journal of a run has one.
bool names_super_journal(const fs::path& rollback) {
  constexpr std::array<unsigned char, 8> kMagic = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
  std::array<char, kMagic.size()> tail{};
  std::ifstream file(rollback, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(kMagic.size()), std::ios::end);
  return file.read(tail.data(), tail.size()) &&
         std::equal(kMagic.begin(), kMagic.end(), tail.begin(),
                    [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
}

constexpr std::string_view kFolderBegins = "rondure-journal-";

/// Suffixes of the copied files: the journal, then its logs.
std::span<const char* const> suffixes_of(PrivateCopy::Logs logs) {
  static constexpr std::array<const char*, 3> kAll = {"", "-wal", "-journal"};
  return std::span(kAll).first(logs == PrivateCopy::Logs::kWith ? kAll.size() : 1);
}

/// Opens a folder of this user and takes its lock, which ends with the process; -1 (errno) when
/// another process holds it or has just removed the folder.
int locked_folder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return -1;
  struct stat opened = {};
  struct stat named = {};
  const bool held = ::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &opened) == 0 &&
                    ::lstat(folder.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
                    opened.st_dev == named.st_dev && opened.st_uid == ::geteuid();
  if (held) return fd;
  ::close(fd);
  return -1;
}

/// Removes the copies of killed programs, whose locks are free. Removes only the files of a copy,
/// so that an unrelated folder of that name keeps its contents.
void remove_left_behind(const fs::path& place) {
  std::error_code ignored;  // a leftover is removed at the next start
  for (const auto& entry : fs::directory_iterator(place, ignored)) {
    if (!entry.path().filename().string().starts_with(kFolderBegins)) continue;
    const int fd = locked_folder(entry.path());
    if (fd < 0) continue;
    for (const char* suffix : {"", "-wal", "-journal", "-shm"}) {
      ::unlinkat(fd, (std::string(kJournalName) + suffix).c_str(), 0);
    }
    ::rmdir(entry.path().c_str());
    ::close(fd);
  }
}

tl::unexpected<core::Error> cannot_copy(const fs::path& journal, std::string_view reason) {
  return core::fail(
      core::Code::kFile,
      fmt::format("the journal cannot be copied to a temporary folder in {}: {}; "
                  "free space there, or name another place in TMPDIR",
                  std::getenv("TMPDIR") == nullptr ? "/tmp" : std::getenv("TMPDIR"), reason),
      journal.string());
}

}  // namespace

std::vector<std::string> logs_beside(const fs::path& journal) {
  std::vector<std::string> out;
  for (const char* suffix : {"-wal", "-journal"}) {
    const fs::path log = journal.string() + suffix;
    std::error_code unknown;  // a log that cannot be examined counts as applicable
    const fs::file_status status = fs::status(log, unknown);
    if (status.type() == fs::file_type::not_found) continue;
    if (fs::is_regular_file(status) && fs::file_size(log, unknown) == 0) continue;
    out.push_back(log.filename().string());
  }
  return out;
}

core::Result<PrivateCopy> PrivateCopy::of(const fs::path& journal, Logs logs) {
  std::error_code problem;
  const fs::path place = fs::temp_directory_path(problem);
  if (problem) return cannot_copy(journal, system_reason(problem.value()));
  for (const char* suffix : suffixes_of(logs)) {
    const fs::path file = journal.string() + suffix;
    const fs::file_status there = fs::status(file, problem);
    if (!fs::exists(there)) continue;
    if (fs::is_regular_file(there)) {
      const std::uintmax_t bytes = fs::file_size(file, problem);
      if (problem || bytes <= kMostJournalBytes) continue;
      return core::fail(core::Code::kFile,
                        fmt::format("{} has {} bytes, the limit for a journal is {}", file.string(),
                                    bytes, kMostJournalBytes),
                        journal.string());
    }
    return core::fail(core::Code::kFile,
                      fmt::format("{}{} is a folder, a device or a pipe, not the file of a journal",
                                  journal.string(), suffix),
                      journal.string());
  }
  remove_left_behind(place);
  PrivateCopy copy = in_new_folder(place);
  if (copy.folder_.empty()) return cannot_copy(journal, system_reason(errno));
  constexpr int kTries = 50;  // retries while a running measurement moves its log into the file
  for (int i = 0; i < kTries; ++i) {
    const auto before = stamp_of(journal, logs);
    problem = copy.take(journal, logs);
    if (problem || stamp_of(journal, logs) != before) continue;
    if (!names_super_journal(copy.file().string() + "-journal")) return copy;
    return core::fail(core::Code::kJournal,
                      fmt::format("{}-journal names other files, which SQLite would change; no run "
                                  "leaves such a file: move it away",
                                  kJournalName),
                      journal.string());
  }
  if (problem) return cannot_copy(journal, system_reason(problem.value()));
  return core::fail(core::Code::kFile,
                    "the run writes faster than its journal can be read; wait until it has ended",
                    journal.string());
}

PrivateCopy PrivateCopy::in_new_folder(const fs::path& place) {
  // retries, because another program may mistake the folder for a leftover
  constexpr int kTries = 20;
  for (int i = 0; i < kTries; ++i) {
    std::string folder = (place / kFolderBegins).string() + "XXXXXX";
    if (::mkdtemp(folder.data()) == nullptr) return {{}, -1};
    const int lock = locked_folder(folder);
    if (lock >= 0) return {folder, lock};
    ::rmdir(folder.c_str());
  }
  return {{}, -1};
}

PrivateCopy::PrivateCopy(fs::path folder, int lock) : folder_(std::move(folder)), lock_(lock) {}

PrivateCopy::PrivateCopy(PrivateCopy&& other) noexcept
    : folder_(std::exchange(other.folder_, {})), lock_(std::exchange(other.lock_, -1)) {}

PrivateCopy::~PrivateCopy() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

fs::path PrivateCopy::file() const { return folder_ / kJournalName; }

std::error_code PrivateCopy::take(const fs::path& journal, Logs logs) const {
  for (const char* suffix : suffixes_of(logs)) {
    const fs::path from = journal.string() + suffix;
    const fs::path to = file().string() + suffix;
    std::error_code problem;
    fs::remove(to, problem);
    fs::copy_file(from, to, problem);
    const bool may_be_absent = *suffix != '\0';
    if (may_be_absent && problem == std::errc::no_such_file_or_directory) continue;
    if (problem) return problem;
    fs::permissions(to, fs::perms::owner_read | fs::perms::owner_write, problem);
    if (problem) return problem;
  }
  return {};
}

}  // namespace rondure::record
