#include "record/private_copy.h"

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

tl::unexpected<core::Error> cannot_copy(const fs::path& journal, std::string_view reason) {
  return core::fail(
      core::Code::kFile,
      fmt::format("the journal cannot be copied to a temporary folder in {}: {}; "
                  "free space there, or name another place in TMPDIR",
                  std::getenv("TMPDIR") == nullptr ? "/tmp" : std::getenv("TMPDIR"), reason),
      journal.string());
}

}  // namespace

core::Result<PrivateCopy> PrivateCopy::of(const fs::path& journal) {
  std::error_code problem;
  const fs::path place = fs::temp_directory_path(problem) / "rondure-XXXXXX";
  std::string folder = place.string();
  if (problem) return cannot_copy(journal, system_reason(problem.value()));
  if (::mkdtemp(folder.data()) == nullptr) return cannot_copy(journal, system_reason(errno));
  PrivateCopy copy{fs::path(folder)};
  constexpr int kTries = 50;  // a run that goes on may fold its log meanwhile: then once more
  for (int i = 0; i < kTries; ++i) {
    const auto before = stamp_of(journal);
    problem = copy.take(journal);
    if (!problem && stamp_of(journal) == before) return copy;
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

std::error_code PrivateCopy::take(const fs::path& journal) const {
  for (const char* suffix : {"", "-wal", "-journal"}) {
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
