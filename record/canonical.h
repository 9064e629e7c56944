#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

// Private to the room: the bytes over which digests run (docs/journal.md, "Bytes of a value"), and
// the rows of a table as such bytes. What reads throws soci::soci_error.

namespace rondure::record {

/// SQLite's own handle of a session.
[[nodiscard]] sqlite_api::sqlite3* handle_of(soci::session& session);

/// Appends an integer, or a text, as canonical bytes.
void append_integer(std::string& bytes, std::int64_t number);
void append_text(std::string& bytes, std::string_view text);

using Statement =
    std::unique_ptr<sqlite_api::sqlite3_stmt, decltype(&sqlite_api::sqlite3_finalize)>;

/// Single rows of one table by their id; prepared once. Must end before its session does.
class RowReader {
 public:
  RowReader(soci::session& session, std::string_view table);
  /// The canonical bytes of a row, columns from left to right; throws when there is none.
  [[nodiscard]] std::string bytes_of(std::int64_t id);

 private:
  soci::session& session_;
  Statement statement_;
};

/// Hands out all rows of a table in the order of their first column, the id.
void for_each_row(soci::session& session, std::string_view table,
                  const std::function<void(std::int64_t id, const std::string& bytes)>& take);

/// Number of rows of a table and one SHA-256 that stands for all their values.
struct Digest {
  std::int64_t rows = 0;
  std::string sha256;

  friend bool operator==(const Digest&, const Digest&) = default;
};

/// SHA-256 over the canonical bytes of all rows of a table.
[[nodiscard]] Digest digest_of(soci::session& session, std::string_view table);

}  // namespace rondure::record
