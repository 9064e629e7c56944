#include "tests/fuzz/row_damage.h"

#include <array>
#include <stdexcept>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/checksums.h"
#include "record/files.h"
#include "record/internal/database.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/schema.h"
#include "record/journal/journal.h"
#include "record/sha256.h"

namespace rondure::fuzz {
namespace {

/// Values as SQL writes them.
constexpr std::array<const char*, 34> kValues = {
    "null",        "0",
    "1",           "-1",
    "2",           "3",
    "7",           "2147483647",
    "-2147483648", "9223372036854775807",
    "1e9",         "-1e9",
    "1.0000001e9", "1e308",
    "9e999",       "-9e999",
    "1e-9",        "1e-300",
    "5e-324",      "-0.0",
    "0.5",         "360.0",
    "''",          "'x'",
    "'NaN'",       "'1e999'",
    "'cylinder'",  "'circle'",
    "'inside'",    "'[]'",
    "'{'",         "char(27)||'[2J'",
    "char(65534)", "replace(hex(zeroblob(3000)), '0', 'a')"};

/// A database that is told what to do and not asked whether it did.
class Rows {
 public:
  explicit Rows(const std::filesystem::path& file) {
    if (sqlite_api::sqlite3_open(file.c_str(), &database_) != SQLITE_OK)
      throw std::runtime_error("no database");
    tell("pragma journal_mode = memory");
    tell("pragma synchronous = off");
  }
  ~Rows() { sqlite_api::sqlite3_close(database_); }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  void tell(const std::string& sql) {
    sqlite_api::sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr);
  }
  [[nodiscard]] std::vector<std::string> ask(const std::string& sql) {
    std::vector<std::string> out;
    const auto take = [](void* list, int /*count*/, char** values, char** /*names*/) {
      static_cast<std::vector<std::string>*>(list)->emplace_back(values[0] ? values[0] : "");
      return 0;
    };
    sqlite_api::sqlite3_exec(database_, sql.c_str(), take, &out, nullptr);
    return out;
  }

 private:
  sqlite_api::sqlite3* database_ = nullptr;
};

}  // namespace

void damage_rows(const std::filesystem::path& file, const std::vector<std::string>& tables,
                 std::mt19937& random) {
  const auto pick = [&random](const auto& from) { return from[random() % from.size()]; };
  Rows rows(file);
  rows.tell("begin");
  for (std::size_t left = 1 + random() % 4; left > 0; --left) {
    const std::string table = pick(tables);
    const auto columns = rows.ask(fmt::format("select name from pragma_table_info('{}')", table));
    const auto ids = rows.ask(fmt::format("select rowid from {}", table));
    if (ids.empty() || columns.empty()) continue;
    const std::string column = pick(columns);
    const std::string id = pick(ids);
    const std::string other = pick(ids);
    const std::string value = pick(kValues);
    switch (random() % 10) {
      case 0:
      case 1:
      case 2:
        rows.tell(fmt::format("update {} set {} = {} where rowid = {}", table, column, value, id));
        break;
      case 3:
        rows.tell(fmt::format("update {} set {} = {}", table, column, value));
        break;
      case 4:
      case 5:
        rows.tell(
            fmt::format("update {0} set {1} = (select {1} from {0} where rowid = {2}) where "
                        "rowid = {3}",
                        table, column, other, id));
        break;
      case 6:
        rows.tell(fmt::format("delete from {} where rowid = {}", table, id));
        break;
      case 7:
        rows.tell(fmt::format("delete from {} where rowid >= {}", table, id));
        break;
      case 8: {
        // Once more, as the next row.
        std::string list;
        for (std::size_t i = 1; i < columns.size(); ++i) list += ", " + columns[i];
        rows.tell(
            fmt::format("insert into {0} select (select max(rowid) + 1 from {0}){1} from {0} "
                        "where rowid = {2}",
                        table, list, id));
        break;
      }
      default:
        rows.tell(fmt::format("update {0} set {1} = {1} * {2} where typeof({1}) <> 'text'", table,
                              column, pick(std::array{"-1", "0", "1000", "1e-6", "1e6"})));
        break;
    }
  }
  rows.tell("commit");
}

void reseal(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / record::kJournalName;
  {
    soci::session sql(soci::sqlite3, record::connection_string(file).value());
    sql << "pragma journal_mode = memory";
    sql << "pragma synchronous = off";
    soci::transaction all(sql);
    sql << "delete from chain";
    sql << "delete from seal";
    {
      record::Chain chain(sql);
      for (const record::Table& table : record::chained_tables()) chain.append_all(table.name);
    }
    record::insert_seal(sql);
    all.commit();
  }
  const auto bytes = record::read_file(file);
  if (!bytes ||
      !record::update_checksums(directory, {{record::kJournalName, record::sha256_hex(*bytes)}})) {
    throw std::runtime_error("no " + std::string(record::kChecksumsName));
  }
}

}  // namespace rondure::fuzz
