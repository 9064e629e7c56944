#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Private to the room: the tables of an archive, alike on both kinds of database.
// docs/archive.md explains them; a test holds both together.

namespace rondure::record {

/// What the two databases spell differently.
struct Dialect {
  std::string_view id_type;      ///< Of a column that counts by itself.
  std::string_view has_archive;  ///< Query: 1 when our tables are there.
  std::string_view begin;        ///< Starts a transaction that writes.
  std::string_view lock;         ///< Keeps a second program from making the tables too; or empty.
};

[[nodiscard]] const Dialect& sqlite_dialect();
[[nodiscard]] const Dialect& postgresql_dialect();

/// The statements that make an archive.
[[nodiscard]] std::vector<std::string> archive_statements(const Dialect& dialect);

/// A number that stands for a name in an index: PostgreSQL indexes no text beyond 2.7 kB. Two names
/// may share one, so the names that come back are compared besides.
[[nodiscard]] std::int64_t key_of(std::string_view name);

}  // namespace rondure::record
