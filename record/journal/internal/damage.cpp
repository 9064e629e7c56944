#include "record/journal/internal/damage.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/internal/database.h"
#include "record/journal/internal/canonical.h"
#include "record/journal/internal/schema.h"

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

/// Row counts from when the journal was closed, as far as the seal can be read.
std::map<std::string, std::int64_t> sealed_rows(soci::session& sql) {
  std::map<std::string, std::int64_t> rows;
  try {
    std::string table;
    std::int64_t count = 0;
    soci::statement all = (sql.prepare << "select table_name, row_count from seal",
                           soci::into(table), soci::into(count));
    all.execute();
    while (all.fetch()) rows[table] = count;
  } catch (const std::exception&) {  // the rows read before the damage count
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

/// Version of the tables; the present one when the header does not state it.
std::int64_t version_of(soci::session& sql) {
  long long version = 0;
  sql << "pragma user_version", soci::into(version);
  return version < kOldestSchemaVersion || version > kSchemaVersion ? kSchemaVersion : version;
}

std::string lost_rows(soci::session& sql) {
  const auto sealed = sealed_rows(sql);
  std::string lost;
  const auto add = [&](const Table& table) {
    const std::string loss = loss_of(sql, table.name, sealed);
    if (!loss.empty()) lost += fmt::format("{}{}", lost.empty() ? "" : ", ", loss);
  };
  const std::int64_t version = version_of(sql);
  for (const Table& table : tables_of(version)) add(table);
  return lost;
}

}  // namespace

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

}  // namespace rondure::record
