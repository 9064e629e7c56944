#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Private to the room: the tables of journal.db. docs/journal.md explains them; a test checks that
// both agree.

namespace rondure::record {

/// "Rond" in SQLite's header: this database is a journal of Rondure.
inline constexpr std::int64_t kApplicationId = 0x526f6e64;
/// Version of the tables below.
inline constexpr std::int64_t kSchemaVersion = 7;
/// The first version with settings of features, and with settings of the whole run.
inline constexpr std::int64_t kFirstSettingVersion = 3;
inline constexpr std::int64_t kFirstRunSettingVersion = 4;
/// The first version in which a touch may have no temperature.
inline constexpr std::int64_t kFirstUnmeasuredVersion = 5;
/// The first version whose decisions are codes with arguments.
inline constexpr std::int64_t kFirstMessageVersion = 6;
/// The first version with lower limits and settings of characteristics.
inline constexpr std::int64_t kFirstIndicationVersion = 7;
/// Runs of this version and later ones are resumed, each in its own version: what is written after
/// the first touch differs in the decisions alone.
inline constexpr std::int64_t kOldestResumedVersion = 5;
/// The first version with a chain.
inline constexpr std::int64_t kFirstChainedVersion = 2;
/// The oldest version that is still read.
inline constexpr std::int64_t kOldestSchemaVersion = 1;

/// One table of the journal.
struct Table {
  std::string_view name;
  std::string sql;                      ///< The statement that creates it, as SQLite stores it.
  std::int64_t since = 1;               ///< The first version with this form of it.
  std::int64_t until = kSchemaVersion;  ///< The last version with this form of it.
};

/// The tables of a version whose rows are linked in the chain, in their order in the seal.
[[nodiscard]] std::vector<Table> chained_tables(std::int64_t version = kSchemaVersion);
/// All tables of a version.
[[nodiscard]] std::vector<Table> tables_of(std::int64_t version);
/// The table of links; absent in version 1.
[[nodiscard]] const Table& chain_table();
/// The table of digests.
[[nodiscard]] const Table& seal_table();

}  // namespace rondure::record
