#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/checksums.h"
#include "record/files.h"
#include "record/internal/database.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/private_copy.h"
#include "record/journal/internal/reader.h"
#include "record/journal/internal/schema.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// The length that the header of a database states, pages times page size
/// (sqlite.org/fileformat2.html, 1.3); nothing when the header is not valid.
std::optional<std::uintmax_t> stated_length(const fs::path& file) {
  constexpr std::size_t kHeadBytes = 32;
  std::array<char, kHeadBytes> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), kHeadBytes);
  if (std::string_view(head.data(), 15) != "SQLite format 3") return std::nullopt;
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uintmax_t value = 0;
    for (std::size_t i = at; i < at + bytes; ++i) {
      value = value << 8U | static_cast<unsigned char>(head[i]);
    }
    return value;
  };
  constexpr std::uintmax_t kLargestPage = 65536;
  const std::uintmax_t page = number(16, 2) == 1 ? kLargestPage : number(16, 2);
  return page * number(28, 4);
}

/// Pads a truncated file to its stated length, so that SQLite reads the rest; says how much is
/// missing.
std::string fill_up(const fs::path& file) {
  std::error_code problem;
  const std::uintmax_t length = fs::file_size(file, problem);
  const std::uintmax_t log = fs::file_size(file.string() + "-wal", problem);
  if (!problem && log > 0) return {};  // the length is in the log
  const auto stated = stated_length(file);
  constexpr std::uintmax_t kLongest = std::uintmax_t{1} << 32;  // a damaged header states anything
  if (!stated || length >= *stated || *stated > kLongest) return {};
  fs::resize_file(file, *stated, problem);
  return fmt::format("the file ends after {} of {} bytes, the last {} are missing", length, *stated,
                     *stated - length);
}

/// Number of rows of a table that can be read, and whether the table ends there.
std::pair<std::int64_t, bool> readable_rows(soci::session& sql, std::string_view table) {
  std::int64_t rows = 0;
  try {
    for_each_row(sql, table, [&](std::int64_t, const std::string&) { ++rows; });
    return {rows, true};
  } catch (const std::exception&) {
    return {rows, false};
  }
}

/// Row counts at the time the journal was closed, as far as the seal can be read.
std::map<std::string, std::int64_t> sealed_rows(soci::session& sql) {
  std::map<std::string, std::int64_t> rows;
  try {
    std::string table;
    std::int64_t count = 0;
    soci::statement all = (sql.prepare << "select table_name, row_count from seal",
                           soci::into(table), soci::into(count));
    all.execute();
    while (all.fetch()) rows[table] = count;
  } catch (const std::exception&) {  // keep the rows read before the damage
  }
  return rows;
}

/// "touch: 120 of 163 rows can be read", or empty when the table is whole.
std::string loss_of(soci::session& sql, std::string_view table,
                    const std::map<std::string, std::int64_t>& sealed) {
  const auto [rows, to_the_end] = readable_rows(sql, table);
  const auto expected = sealed.find(std::string(table));
  if (expected != sealed.end() && rows < expected->second) {
    return fmt::format("{}: {} of {} rows can be read", table, rows, expected->second);
  }
  return to_the_end ? std::string() : fmt::format("{}: only {} rows can be read", table, rows);
}

std::string lost_rows(soci::session& sql) {
  const auto sealed = sealed_rows(sql);
  std::string lost;
  for (const Table& table : all_tables()) {
    const std::string loss = loss_of(sql, table.name, sealed);
    if (!loss.empty()) lost += fmt::format("{}{}", lost.empty() ? "" : ", ", loss);
  }
  return lost;
}

/// Describes for the operator what a damaged journal has lost: the number of bytes missing at its
/// end, and the tables that can no longer be read in full, with the number of readable rows. Empty
/// when no such loss is found. `copy` is a private copy; it is padded with zeros.
std::string loss_in_words(const fs::path& copy) {
  std::string words = fill_up(copy);
  const auto connection = connection_string(copy);
  if (!connection) return words;
  try {
    soci::session sql(soci::sqlite3, *connection);
    distrust(sql);
    int tables = 0;  // a file without tables is not a damaged journal
    sql << "select count(*) from sqlite_schema where name in ('header', 'touch')",
        soci::into(tables);
    if (tables == 0) return words;
    const std::string lost = lost_rows(sql);
    if (!lost.empty()) words += fmt::format("{}{}", words.empty() ? "" : "; ", lost);
  } catch (const std::exception&) {  // not even the list of tables can be read
    if (!words.empty()) words += "; none of its tables can be read";
  }
  return words;
}

bool is_damage(const std::exception& exception) {
  const auto* error = dynamic_cast<const soci::sqlite3_soci_error*>(&exception);
  return (error != nullptr && (error->result() & 0xff) == SQLITE_CORRUPT) ||
         dynamic_cast<const Damage*>(&exception) != nullptr;
}

constexpr const char* kCopyAgain =
    "copy the run directory again from where it was measured, or from a backup";

std::string advice_after(const std::string& loss) {
  return fmt::format("{}{}; {}", loss.empty() ? "" : "; ", loss, kCopyAgain);
}

/// Whether the file of a journal is empty.
bool holds_nothing(const fs::path& file) {
  std::error_code absent;
  const auto log = fs::file_size(file.string() + "-wal", absent);
  return (absent || log == 0) && fs::file_size(file, absent) == 0 && !absent;
}

core::Result<void> require_file(const fs::path& directory, const fs::path& file) {
  std::error_code problem;
  const auto refuse = [&](std::string what) {
    return core::fail(core::Code::kFile, std::move(what), file.string());
  };
  if (fs::is_symlink(file, problem)) {
    return refuse("the journal is a link, not a file of this run; put the file itself there");
  }
  const fs::file_status status = fs::status(file, problem);
  if (fs::is_regular_file(status) && holds_nothing(file)) {
    return core::fail(
        core::Code::kJournal,
        fmt::format("the journal cannot be read: it is empty; a run that died as it began left it, "
                    "then begin again, or its contents were lost, then {}",
                    kCopyAgain),
        file.string());
  }
  if (fs::is_regular_file(status)) return {};
  const bool lost = fs::exists(directory / kChecksumsName, problem);
  if (status.type() == fs::file_type::not_found && lost) {
    return refuse(fmt::format("there is no {} in {}, but a {}: the journal of a run was lost; {}",
                              kJournalName, directory.string(), kChecksumsName, kCopyAgain));
  }
  if (status.type() == fs::file_type::not_found) {
    return refuse(fmt::format("there is no {} in {}; name the directory of a run", kJournalName,
                              directory.string()));
  }
  if (fs::exists(status)) return refuse("the journal is not a file; name the directory of a run");
  return refuse(fmt::format("the journal cannot be looked at: {}", system_reason(problem.value())));
}

using Logs = PrivateCopy::Logs;

core::Result<ReadJournal> read_copy(const fs::path& file, Logs logs) {
  TRY(const auto copy, PrivateCopy::of(file, logs));
  TRY(const auto connection, connection_string(copy.file()));
  std::optional<soci::session> sql;
  std::string reason;
  try {
    sql.emplace(soci::sqlite3, connection);
    distrust(*sql);
    *sql << "pragma synchronous = off";  // the copy need not survive a power cut
    return read_tables(*sql);
  } catch (const std::exception& exception) {
    reason = reason_of(exception, sql ? &*sql : nullptr);
    if (is_damage(exception)) {
      sql.reset();
      reason += advice_after(loss_in_words(copy.file()));
    }
  }
  return core::fail(core::Code::kJournal, fmt::format("the journal cannot be read: {}", reason),
                    file.string());
}

/// The digest of the journal in SHA256SUMS, if it is listed there.
std::optional<std::string> listed_digest(const fs::path& directory) {
  const auto list = read_checksums(directory);
  if (!list) return std::nullopt;
  const auto line = std::find_if(list->begin(), list->end(),
                                 [](const Checksum& c) { return c.file == kJournalName; });
  return line == list->end() ? std::nullopt : std::optional(line->sha256);
}

bool has_digest(const fs::path& file, const std::string& sha256) {
  return sha256_inside(file.parent_path(), file.filename()).value_or("") == sha256;
}

/// The journal without its logs, if it is whole and sealed.
std::optional<ReadJournal> closed_journal(const fs::path& file) {
  if (in_copy(file, Logs::kWithout, is_sealed).value_or(std::nullopt) != true) return std::nullopt;
  auto alone = read_copy(file, Logs::kWithout);
  if (!alone || !alone->record.sealed || !alone->broken.empty()) return std::nullopt;
  return *std::move(alone);
}

/// Whether the logs change anything: a run that died while closing its journal may leave a log
/// whose rows are already in the file.
bool logs_change(const fs::path& file) {
  const auto contents = [&](soci::session& sql) {
    std::string digests = digest_of(sql, "sqlite_schema").sha256;
    for (const Table& table : all_tables()) digests += digest_of(sql, table.name).sha256;
    return digests;
  };
  const auto alone = in_copy(file, Logs::kWithout, contents).value_or(std::nullopt);
  return !alone || in_copy(file, Logs::kWith, contents).value_or(std::nullopt) != alone;
}

/// Whether a file begins like a log of SQLite, or is one that a killed program had only started: it
/// is empty, or its header, which is written last, is still zeros.
bool begins_as_log(const fs::path& file) {
  constexpr std::array<std::string_view, 3> kBeginnings = {"\x37\x7f\x06\x82", "\x37\x7f\x06\x83",
                                                           "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7"};
  constexpr std::size_t kMagic = 8;
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return false;
  std::string head(kMagic, '\0');
  std::ifstream log(file, std::ios::binary);
  if (!log) return false;
  log.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(log.gcount()));
  if (head.find_first_not_of('\0') == std::string::npos) return true;
  return std::any_of(kBeginnings.begin(), kBeginnings.end(),
                     [&](std::string_view start) { return head.starts_with(start); });
}

}  // namespace

core::Result<ReadJournal> read_journal(const fs::path& directory) {
  const fs::path file = directory / kJournalName;
  TRY_DO(require_file(directory, file));
  const auto listed = listed_digest(directory);
  const std::vector<std::string> logs = logs_beside(file);
  if (!listed && !logs.empty()) {
    if (auto closed = closed_journal(file)) {
      const bool all_are_logs = std::all_of(logs.begin(), logs.end(), [&](const std::string& log) {
        return begins_as_log(directory / log);
      });
      if (!all_are_logs || logs_change(file)) closed->beside = logs;
      return *std::move(closed);
    }
  }
  auto read = read_copy(file, listed ? Logs::kWithout : Logs::kWith);
  if (read) {
    read->listed = listed.has_value();
    read->as_listed = !listed || has_digest(file, *listed);
    if (listed) read->beside = logs;
  }
  return read;
}

std::vector<std::string> faults_of(const ReadJournal& journal) {
  std::vector<std::string> out;
  for (const BrokenTable& broken : journal.broken) {
    out.push_back(fmt::format("table {} of the journal was changed after the run: {}", broken.table,
                              broken.what));
  }
  if (!journal.as_listed) {
    out.push_back(
        fmt::format("{} is not the file that {} names: its bytes were changed after its "
                    "run closed it",
                    kJournalName, kChecksumsName));
  }
  for (const std::string& log : journal.beside) {
    out.push_back(
        fmt::format("{} stands beside the closed journal and may change what other "
                    "programs find in it; it was not read: move it away",
                    log));
  }
  return out;
}

}  // namespace rondure::record
