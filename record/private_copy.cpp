#include "record/private_copy.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

#include "record/files.h"
#include "record/journal.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Changes whenever the log is folded into the file: time of the file and head of the log.
std::pair<fs::file_time_type, std::string> stamp_of(const fs::path& journal) {
  std::error_code ignored;
  constexpr std::size_t kLogHead = 32;
  std::array<char, kLogHead> head{};
  std::ifstream log(journal.string() + "-wal", std::ios::binary);
  log.read(head.data(), kLogHead);
  return {fs::last_write_time(journal, ignored), std::string(head.data(), kLogHead)};
}

/// Whether a rollback journal ends in the name of a super-journal (sqlite.org/fileformat2.html,
/// 3): a file that SQLite reads, and may delete, wherever it is. No journal of a run has one.
bool names_super_journal(const fs::path& rollback) {
  constexpr std::array<unsigned char, 8> kMagic = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
  std::array<char, kMagic.size()> tail{};
  std::ifstream file(rollback, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(kMagic.size()), std::ios::end);
  return file.read(tail.data(), tail.size()) &&
         std::equal(kMagic.begin(), kMagic.end(), tail.begin(),
                    [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
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
    std::error_code unknown;  // what cannot be looked at may well be applied
    const fs::file_status status = fs::status(log, unknown);
    if (status.type() == fs::file_type::not_found) continue;
    if (fs::is_regular_file(status) && fs::file_size(log, unknown) == 0) continue;
    out.push_back(log.filename().string());
  }
  return out;
}

core::Result<PrivateCopy> PrivateCopy::of(const fs::path& journal, Logs logs) {
  std::error_code problem;
  const fs::path place = fs::temp_directory_path(problem) / "rondure-XXXXXX";
  std::string folder = place.string();
  if (problem) return cannot_copy(journal, system_reason(problem.value()));
  if (::mkdtemp(folder.data()) == nullptr) return cannot_copy(journal, system_reason(errno));
  PrivateCopy copy{fs::path(folder)};
  constexpr int kTries = 50;  // a run that goes on may fold its log meanwhile: then once more
  for (int i = 0; i < kTries; ++i) {
    const auto before = stamp_of(journal);
    problem = copy.take(journal, logs);
    if (problem || stamp_of(journal) != before) continue;
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

PrivateCopy::PrivateCopy(fs::path folder) : folder_(std::move(folder)) {}

PrivateCopy::PrivateCopy(PrivateCopy&& other) noexcept
    : folder_(std::exchange(other.folder_, {})) {}

PrivateCopy::~PrivateCopy() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

fs::path PrivateCopy::file() const { return folder_ / kJournalName; }

std::error_code PrivateCopy::take(const fs::path& journal, Logs logs) const {
  for (const char* suffix : {"", "-wal", "-journal"}) {
    if (*suffix != '\0' && logs == Logs::kWithout) continue;
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
