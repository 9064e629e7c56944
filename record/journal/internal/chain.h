#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <soci/soci.h>

#include "record/internal/database.h"
#include "record/journal/journal.h"

namespace rondure::record {

// Private to the room: the bytes over which digests are computed (docs/developer/journal.md, "Bytes
// of a value"), and the rows of a table as such bytes. Functions that read throw soci::soci_error.

/// Appends one value as canonical bytes.
void append_integer(std::string& bytes, std::int64_t number);
void append_real(std::string& bytes, double number);
void append_text(std::string& bytes, std::string_view text);
void append_null(std::string& bytes);

/// Appends a value as the journal stores it: null for an empty optional.
template <class Value>
void append_given(std::string& bytes, const Value& value) {
  if constexpr (std::is_integral_v<Value>) {
    append_integer(bytes, value);
  } else if constexpr (std::is_floating_point_v<Value>) {
    append_real(bytes, value);
  } else {
    append_text(bytes, value);
  }
}
template <class Value>
void append_given(std::string& bytes, const std::optional<Value>& value) {
  if (value) {
    append_given(bytes, *value);
  } else {
    append_null(bytes);
  }
}

/// The canonical bytes of a row with these values, from left to right.
template <class... Values>
[[nodiscard]] std::string row_bytes(const Values&... values) {
  std::string bytes;
  (append_given(bytes, values), ...);
  return bytes;
}

/// Calls `take` for every row of a table, in the order of the first column, the id.
void for_each_row(soci::session& session, std::string_view table,
                  const std::function<void(std::int64_t id, const std::string& bytes)>& take);

/// Number of rows of a table and one SHA-256 over all their values.
struct Digest {
  std::int64_t rows = 0;
  std::string sha256;

  friend bool operator==(const Digest&, const Digest&) = default;
};

/// SHA-256 over the canonical bytes of all rows of a table.
[[nodiscard]] Digest digest_of(soci::session& session, std::string_view table);

// Private to the room: the hash chain over everything that is written, and the seal that closes a
// journal. Throws soci::soci_error.

/// Writes the chain. Each row that is written or changed gets a link in table `chain`, in the same
/// transaction: the SHA-256 of the row, and a SHA-256 over the digest of the previous link and the
/// fields of this one. A row edited or removed later does not match its link, and an edited or
/// removed link does not match the next one; this holds for unsealed journals too.
class Chain {
 public:
  /// Continues after the last link of the table.
  explicit Chain(soci::session& sql);

  /// Links row `row` of `table` with the values passed to the database, those after the id from
  /// left to right. They are not read back, because the database might have changed them.
  template <class... Values>
  void append(std::string_view table, std::int64_t row, const Values&... values) {
    append_bytes(table, row, row_bytes(row, values...));
  }
  /// Same as append(), for the row that was inserted last.
  template <class... Values>
  void append_inserted(std::string_view table, const Values&... values) {
    append(table, sqlite_api::sqlite3_last_insert_rowid(handle_of(sql_)), values...);
  }
  /// Links all rows of a table, by id, as the database returns them. For a table created in the
  /// same transaction.
  void append_all(std::string_view table);

  /// Call after the transaction around the links was committed, or was rolled back.
  void commit() { committed_ = tip_; }
  void roll_back() { tip_ = committed_; }

 private:
  struct Link {
    std::int64_t id = 0;
    std::string table;
    std::int64_t row = 0;
    std::string row_sha256;
  };
  void append_bytes(std::string_view table, std::int64_t row, const std::string& bytes);

  soci::session& sql_;
  Digest tip_;        ///< Number of links and the last one's digest.
  Digest committed_;  ///< The same as stored on disk.
  Link link_;         ///< Bound to the statement.
  soci::statement insert_;
};

/// Fills the seal with the digest of every other table and the head of the chain.
void insert_seal(soci::session& sql);

[[nodiscard]] bool is_sealed(soci::session& sql);

/// Checks the chain and, in a sealed journal, every digest of the seal. A table
/// that fails both is reported once, with the number of rows and the name of the first bad row.
[[nodiscard]] std::vector<BrokenTable> check_seal(soci::session& sql);

}  // namespace rondure::record
