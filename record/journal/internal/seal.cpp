#include "record/journal/internal/seal.h"

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "record/journal/internal/canonical.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/schema.h"

namespace rondure::record {
namespace {

using soci::into;
using soci::use;

/// The digest of a table in the seal; for the chain it is the head of the chain.
Digest seal_digest_of(soci::session& sql, const Table& table) {
  return table.name == chain_table().name ? chain_head(sql) : digest_of(sql, table.name);
}

std::vector<Table> sealed_tables(std::int64_t version) {
  std::vector<Table> tables = chained_tables(version);
  if (version >= kFirstChainedVersion) tables.push_back(chain_table());
  return tables;
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

void insert_seal(soci::session& sql, std::int64_t version) {
  for (const Table& table : sealed_tables(version)) {
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

std::vector<BrokenTable> check_seal(soci::session& sql, std::int64_t version) {
  std::vector<BrokenTable> broken;
  if (version >= kFirstChainedVersion) broken = check_chain(sql, version);
  if (!is_sealed(sql)) return broken;
  for (const Table& table : sealed_tables(version)) {
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
