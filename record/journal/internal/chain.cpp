#include "record/journal/internal/chain.h"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "record/internal/database.h"
#include "record/journal/internal/schema.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

/// Appends the eight bytes of a number, lowest first, on any processor.
void append_number(std::string& bytes, std::uint64_t number) {
  for (unsigned shift = 0; shift < 64; shift += 8) {
    bytes += static_cast<char>((number >> shift) & 0xffU);
  }
}

/// Appends the canonical bytes of one value: a letter for its type, then the value.
void append_value(std::string& bytes, sqlite_api::sqlite3_stmt* row, int column) {
  switch (sqlite_api::sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
      append_integer(bytes, sqlite_api::sqlite3_column_int64(row, column));
      break;
    case SQLITE_FLOAT:
      append_real(bytes, sqlite_api::sqlite3_column_double(row, column));
      break;
    case SQLITE_NULL:
      append_null(bytes);
      break;
    default: {  // text; the schema has no other type
      const void* text = sqlite_api::sqlite3_column_blob(row, column);
      const auto size = static_cast<std::size_t>(sqlite_api::sqlite3_column_bytes(row, column));
      append_text(bytes, size == 0 ? std::string_view()
                                   : std::string_view(static_cast<const char*>(text), size));
    }
  }
}

void append_row(std::string& bytes, sqlite_api::sqlite3_stmt* row) {
  const int columns = sqlite_api::sqlite3_column_count(row);
  for (int column = 0; column < columns; ++column) append_value(bytes, row, column);
}

[[noreturn]] void fail(soci::session& session, int state) {
  throw soci::sqlite3_soci_error(sqlite_api::sqlite3_errmsg(handle_of(session)), state);
}

using Statement =
    std::unique_ptr<sqlite_api::sqlite3_stmt, decltype(&sqlite_api::sqlite3_finalize)>;

Statement prepared(soci::session& session, const std::string& query) {
  sqlite_api::sqlite3_stmt* raw = nullptr;
  const int state =
      sqlite_api::sqlite3_prepare_v2(handle_of(session), query.c_str(), -1, &raw, nullptr);
  Statement statement(raw, &sqlite_api::sqlite3_finalize);
  if (state != SQLITE_OK) fail(session, state);
  return statement;
}

}  // namespace

void append_integer(std::string& bytes, std::int64_t number) {
  bytes += 'i';
  append_number(bytes, static_cast<std::uint64_t>(number));
}

void append_real(std::string& bytes, double number) {
  bytes += 'r';
  append_number(bytes, std::bit_cast<std::uint64_t>(number));
}

void append_text(std::string& bytes, std::string_view text) {
  bytes += 't';
  append_number(bytes, text.size());
  bytes.append(text);
}

void append_null(std::string& bytes) { bytes += 'n'; }

void for_each_row(soci::session& session, std::string_view table,
                  const std::function<void(std::int64_t id, const std::string& bytes)>& take) {
  const Statement row = prepared(session, fmt::format("select * from {} order by 1", table));
  std::string bytes;
  int state = SQLITE_ROW;
  while ((state = sqlite_api::sqlite3_step(row.get())) == SQLITE_ROW) {
    bytes.clear();
    append_row(bytes, row.get());
    take(sqlite_api::sqlite3_column_int64(row.get(), 0), bytes);
  }
  if (state != SQLITE_DONE) fail(session, state);
}

Digest digest_of(soci::session& session, std::string_view table) {
  Digest digest;
  Sha256 hash;
  for_each_row(session, table, [&](std::int64_t, const std::string& bytes) {
    hash.add(bytes);
    ++digest.rows;
  });
  digest.sha256 = hash.hex();
  return digest;
}

namespace {

using soci::into;
using soci::use;

/// The digest of a link: over the digest of the previous link (empty text for the first) and all
/// fields of this link.
std::string link_sha256(std::string_view before, std::int64_t id, std::string_view table,
                        std::int64_t row, std::string_view row_sha256) {
  std::string bytes;
  append_text(bytes, before);
  append_integer(bytes, id);
  append_text(bytes, table);
  append_integer(bytes, row);
  append_text(bytes, row_sha256);
  return sha256_hex(bytes);
}

/// "touch 41", "the header".
std::string name_of_row(std::string_view table, std::int64_t row) {
  if (table == "header" || table == "artefact") return fmt::format("the {}", table);
  return fmt::format("{} {}", table, row);
}

/// The last digest of each row of one table, from the links.
using Expected = std::unordered_map<std::int64_t, std::string>;

/// Collects the mismatches of one table: the first in words, the others by number.
class Mismatches {
 public:
  void add(std::string what) {
    if (++count_ == 1) first_ = std::move(what);
  }
  void report(std::string_view table, std::vector<BrokenTable>& out) const {
    if (count_ == 0) return;
    out.push_back({std::string(table),
                   count_ == 1 ? first_ : fmt::format("{} (and {} more)", first_, count_ - 1)});
  }

 private:
  std::string first_;
  std::size_t count_ = 0;
};

/// Reads all links; reports those that do not follow from the previous one.
std::map<std::string, Expected> follow_links(soci::session& sql, std::vector<BrokenTable>& out) {
  std::map<std::string, Expected> expected;
  Mismatches mismatches;
  std::int64_t id = 0;
  std::int64_t row = 0;
  std::string table;
  std::string row_sha256;
  std::string sha256;
  soci::statement links =
      (sql.prepare << "select id, table_name, row_id, row_sha256, sha256 from chain order by id",
       into(id), into(table), into(row), into(row_sha256), into(sha256));
  links.execute();
  std::int64_t next = 0;
  std::string before;
  while (links.fetch()) {
    if (id != next) {
      mismatches.add(id == next + 1 ? fmt::format("link {} was removed", next)
                                    : fmt::format("links {} to {} were removed", next, id - 1));
    } else if (link_sha256(before, id, table, row, row_sha256) != sha256) {
      mismatches.add(fmt::format("link {} ({}) does not follow from the links before it", id,
                                 name_of_row(table, row)));
    }
    next = id + 1;
    before = sha256;
    expected[table][row] = row_sha256;
  }
  mismatches.report(chain_table().name, out);
  return expected;
}

/// Compares the rows of one table with the digests in the links.
void compare_rows(soci::session& sql, std::string_view table, Expected expected,
                  std::vector<BrokenTable>& out) {
  Mismatches mismatches;
  for_each_row(sql, table, [&](std::int64_t id, const std::string& bytes) {
    const auto link = expected.find(id);
    if (link == expected.end()) {
      mismatches.add(
          fmt::format("{} has no link: it was not written by the run", name_of_row(table, id)));
      return;
    }
    if (link->second != sha256_hex(bytes)) {
      mismatches.add(fmt::format("{} was changed after it was written", name_of_row(table, id)));
    }
    expected.erase(link);
  });
  std::optional<std::int64_t> first;
  for (const auto& [id, digest] : expected) first = first ? std::min(*first, id) : id;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    mismatches.add(fmt::format("{} was removed after it was written", name_of_row(table, *first)));
  }
  mismatches.report(table, out);
}

/// Number of links, and the digest of the last: the head of the chain, which represents all rows.
Digest chain_head(soci::session& sql) {
  Digest head;
  sql << "select count(*) from chain", into(head.rows);
  if (head.rows > 0) {
    sql << "select sha256 from chain order by id desc limit 1", into(head.sha256);
  }
  return head;
}

/// Follows the chain and describes the first mismatch of each table in words that name the row;
/// table "chain" when the links themselves do not follow from each other. O(rows).
std::vector<BrokenTable> check_chain(soci::session& sql) {
  std::vector<BrokenTable> out;
  auto expected = follow_links(sql, out);
  for (const Table& table : chained_tables()) {
    compare_rows(sql, table.name, std::move(expected[std::string(table.name)]), out);
    expected.erase(std::string(table.name));
  }
  for (const auto& [table, rows] : expected) {
    out.push_back({std::string(chain_table().name),
                   fmt::format("a link names the unknown table \"{}\"", table.substr(0, 40))});
  }
  return out;
}

/// The digest of a table in the seal; for the chain it is the head of the chain.
Digest seal_digest_of(soci::session& sql, const Table& table) {
  return table.name == chain_table().name ? chain_head(sql) : digest_of(sql, table.name);
}

/// Compares one table with its row in the seal.
std::optional<BrokenTable> compare(soci::session& sql, const Table& table) {
  const std::string name(table.name);
  Digest stored;
  sql << "select row_count, sha256 from seal where table_name = :name", into(stored.rows),
      into(stored.sha256), use(name);
  if (!sql.got_data()) return BrokenTable{name, "its digest is missing in the seal"};
  const Digest found = seal_digest_of(sql, table);
  if (found.rows != stored.rows) {
    return BrokenTable{name, fmt::format("{} rows, expected {}", found.rows, stored.rows)};
  }
  if (found != stored) return BrokenTable{name, "a value differs from the sealed one"};
  return std::nullopt;
}

}  // namespace

Chain::Chain(soci::session& sql)
    : sql_(sql),
      tip_(chain_head(sql)),
      committed_(tip_),
      insert_((sql.prepare << "insert into chain values (:id, :table, :row, :row_sha256, :sha256)",
               use(link_.id), use(link_.table), use(link_.row), use(link_.row_sha256),
               use(tip_.sha256))) {}

void Chain::append_all(std::string_view table) {
  for_each_row(sql_, table, [&](std::int64_t row, const std::string& bytes) {
    append_bytes(table, row, bytes);
  });
}

void Chain::append_bytes(std::string_view table, std::int64_t row, const std::string& bytes) {
  link_ = {tip_.rows, std::string(table), row, sha256_hex(bytes)};
  tip_.sha256 = link_sha256(tip_.sha256, link_.id, table, row, link_.row_sha256);
  insert_.execute(true);
  ++tip_.rows;
}

void insert_seal(soci::session& sql) {
  for (const Table& table : sealed_tables()) {
    const Digest digest = seal_digest_of(sql, table);
    const std::string name(table.name);
    sql << "insert into seal (table_name, row_count, sha256) values (:name, :rows, :sha256)",
        use(name), use(digest.rows), use(digest.sha256);
  }
}

bool is_sealed(soci::session& sql) {
  int rows = 0;
  sql << "select count(*) from seal", into(rows);
  return rows > 0;
}

std::vector<BrokenTable> check_seal(soci::session& sql) {
  std::vector<BrokenTable> broken = check_chain(sql);
  if (!is_sealed(sql)) return broken;
  for (const Table& table : sealed_tables()) {
    const auto differs = compare(sql, table);
    if (!differs) continue;
    const auto known = std::find_if(broken.begin(), broken.end(),
                                    [&](const auto& b) { return b.table == differs->table; });
    if (known == broken.end()) {
      broken.push_back(*differs);
    } else {
      known->what = fmt::format("{}: {}", differs->what, known->what);
    }
  }
  return broken;
}

}  // namespace rondure::record
