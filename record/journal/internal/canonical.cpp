#include "record/journal/internal/canonical.h"

#include <bit>
#include <memory>

#include <fmt/format.h>

#include "record/internal/database.h"
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

}  // namespace rondure::record
