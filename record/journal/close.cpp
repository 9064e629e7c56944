#include <algorithm>

#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/internal/impl.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Writes the digest of the closed journal into the list beside it.
core::Result<void> list_digest(const fs::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return core::fail(bytes.error());
  return update_checksums(file.parent_path(), {{kJournalName, sha256_hex(*bytes)}});
}

}  // namespace

core::Result<void> Journal::seal(std::span<const StoredResult> results) {
  Impl& impl = *impl_;
  if (impl.state == Impl::State::kOpen) {
    auto written = impl.write("the seal", [&] {
      insert_results(impl.sql, *impl.chain, results);
      insert_seal(impl.sql, impl.version);
    });
    if (!written) return written;
    impl.state = Impl::State::kDigested;
  }
  if (impl.state == Impl::State::kClosed) {
    return impl.failure("the seal", "it stands there already");
  }
  if (impl.state == Impl::State::kDigested) {
    if (auto folded = impl.fold(); !folded) return folded;
  }
  auto listed = list_digest(impl.file);
  if (listed) impl.state = Impl::State::kClosed;
  return listed;
}

core::Result<void> Journal::finish_seal(const fs::path& directory) {
  const fs::path file = fs::absolute(directory) / kJournalName;
  std::error_code ignored;
  if (fs::exists(directory / kChecksumsName, ignored)) {
    const auto listed = read_checksums(directory);
    if (!listed) return core::fail(listed.error());
    const bool known = std::any_of(listed->begin(), listed->end(),
                                   [](const Checksum& line) { return line.file == kJournalName; });
    if (known) return {};
  }
  const auto connection = connection_string(file);
  if (!connection) return core::fail(connection.error());
  std::optional<soci::session> sql;
  try {
    sql.emplace(soci::sqlite3, *connection);
    distrust(*sql);
    int tables = 0;  // this read rolls back an unfinished change of the mode
    *sql << "select count(*) from sqlite_schema", soci::into(tables);
    checkpoint_wal(*sql);
    disable_wal(*sql);
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the log of {} cannot be folded: {}", file.string(),
                                  reason_of(exception, sql ? &*sql : nullptr)),
                      file.string());
  }
  sql.reset();
  // Left by a process that died in disable_wal(): SQLite has rolled back or finished its contents,
  // but keeps the file.
  fs::remove(file.string() + "-journal", ignored);
  return list_digest(file);
}

}  // namespace rondure::record
