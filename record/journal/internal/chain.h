#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <soci/soci.h>

#include "record/journal/internal/canonical.h"
#include "record/journal/journal.h"

// Private to the room: the hash chain over all written rows. Throws soci::soci_error.

namespace rondure::record {

/// Writes the chain. Each row that is written or changed gets a link in table `chain`, in the same
/// transaction: the SHA-256 of the row, and a SHA-256 over the link before it and all fields of
/// this one. A row that is edited or removed afterwards no longer matches its link, and a link that
/// is edited or removed no longer matches the next one, also in a journal that was never sealed.
class Chain {
 public:
  /// Continues after the last link of the table.
  explicit Chain(soci::session& sql);

  /// Links row `row` of `table` with the values passed to the database, those after the id from
  /// left to right. Values read back are not used: the database might have changed them.
  template <class... Values>
  void append(std::string_view table, std::int64_t row, const Values&... values) {
    append_bytes(table, row, row_bytes(row, values...));
  }
  /// Same as append(), for the row that was inserted last.
  template <class... Values>
  void append_inserted(std::string_view table, const Values&... values) {
    append(table, sqlite_api::sqlite3_last_insert_rowid(handle_of(sql_)), values...);
  }
  /// Links all rows of a table, by id, with the values read back. For a table created in the same
  /// transaction.
  void append_all(std::string_view table);

  /// The transaction around the links was committed, or was rolled back.
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
  Digest tip_;   ///< Number of links and the last one's digest.
  Digest kept_;  ///< State of `tip_` on disk.
  Link link_;    ///< Bound to the statement.
  soci::statement insert_;
};

/// Number of links, and the digest of the last: the head of the chain, which covers all rows.
[[nodiscard]] Digest chain_head(soci::session& sql);

/// Checks the chain. Returns for each table the first mismatch, in words that name the row; table
/// "chain" when the links themselves do not follow from each other. O(rows).
/// @param version  Version of the tables.
[[nodiscard]] std::vector<BrokenTable> check_chain(soci::session& sql, std::int64_t version);

}  // namespace rondure::record
