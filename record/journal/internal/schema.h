#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// Private to the room: the tables of journal.db. docs/developer/journal.md explains them; a test
// checks that both agree.

namespace rondure::record {

/// "Rond" in SQLite's header: this database is a journal of Rondure.
inline constexpr std::int64_t kApplicationId = 0x526f6e64;
/// Version of the tables below, the only one that is read.
inline constexpr std::int64_t kSchemaVersion = 8;

/// One table of the journal.
struct Table {
  std::string_view name;
  std::string sql;  ///< The statement that creates it, as SQLite stores it.
};

/// All tables. The last two are the chain and the seal.
[[nodiscard]] std::span<const Table> all_tables();
/// The tables that the seal covers, in their order in it: all but the seal itself.
[[nodiscard]] std::span<const Table> sealed_tables();
/// The tables whose rows are linked in the chain.
[[nodiscard]] std::span<const Table> chained_tables();
/// The table of links.
[[nodiscard]] const Table& chain_table();
/// The table of digests.
[[nodiscard]] const Table& seal_table();

}  // namespace rondure::record
