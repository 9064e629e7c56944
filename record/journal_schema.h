#pragma once

#include <cstdint>
#include <span>
#include <string_view>

// Private to the room: the tables of journal.db. docs/journal.md explains them; a test holds both
// together.

namespace rondure::record {

/// "Rond" in SQLite's header: this database is a journal of ours.
inline constexpr std::int64_t kApplicationId = 0x526f6e64;
/// Counts changes of the tables below.
inline constexpr std::int64_t kSchemaVersion = 1;

/// One table of the journal.
struct Table {
  std::string_view name;
  std::string_view sql;  ///< The statement that makes it, as SQLite keeps it.
};

/// The tables that a seal covers, in their order in the seal.
[[nodiscard]] std::span<const Table> sealed_tables();
/// The table of the digests themselves.
[[nodiscard]] const Table& seal_table();

}  // namespace rondure::record
