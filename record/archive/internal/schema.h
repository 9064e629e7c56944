#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Private to the room: the tables of an archive, the same on both kinds of database.
// docs/archive.md explains them; a test checks that both agree.

namespace rondure::record {

/// SQL that differs between the two databases.
struct Dialect {
  std::string_view id_type;      ///< Type of a column with automatic row numbers.
  std::string_view has_archive;  ///< Query: 1 when the tables of this program exist.
  std::string_view begin;        ///< Starts a transaction that writes.
  std::string_view lock;  ///< Prevents a second program from creating the tables; may be empty.
};

[[nodiscard]] const Dialect& sqlite_dialect();
[[nodiscard]] const Dialect& postgresql_dialect();

/// The statements that create an archive.
[[nodiscard]] std::vector<std::string> archive_statements(const Dialect& dialect);

/// A number that represents a name in an index: PostgreSQL cannot index text longer than 2.7 kB.
/// Two names may share a number, so the names of the rows found are compared as well.
[[nodiscard]] std::int64_t key_of(std::string_view name);

}  // namespace rondure::record
