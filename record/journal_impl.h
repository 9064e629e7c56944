#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/chain.h"
#include "record/database.h"
#include "record/journal.h"
#include "record/journal_log.h"
#include "record/journal_reader.h"
#include "record/journal_rows.h"
#include "record/run_lock.h"

// Private to the room: the open journal. journal_open.cpp makes it, journal.cpp writes rows,
// journal_close.cpp seals it.

namespace rondure::record {

struct Journal::Impl {
  enum class State { kOpen, kDigested, kFolded, kClosed };

  RunLock lock;  ///< Before the session: given back after the journal is closed.
  std::filesystem::path file;
  soci::session sql;
  std::optional<Statements> statements;
  std::optional<Chain> chain;
  std::optional<std::int64_t> last_touch;
  bool ended = false;
  State state = State::kOpen;
  std::shared_ptr<GrowingRecord> follower;  ///< Or none.

  Impl(RunLock taken, std::filesystem::path path, const std::string& connection)
      : lock(std::move(taken)), file(std::move(path)), sql(soci::sqlite3, connection) {}

  /// Why `subject` is not in the journal, and what is safe.
  [[nodiscard]] tl::unexpected<core::Error> failure(std::string_view subject,
                                                    std::string_view reason) const {
    return core::fail(
        core::Code::kJournal,
        fmt::format("{} cannot be written to {}: {}{}", subject, file.string(), reason,
                    last_touch ? fmt::format("; the touches up to number {} are kept", *last_touch)
                               : std::string()));
  }

  /// Runs `action`, which writes `subject` in one transaction.
  template <class Action>
  core::Result<void> write(std::string_view subject, const Action& action) {
    if (state != State::kOpen) {
      return failure(subject, "the journal is sealed and takes nothing more; start a new run");
    }
    try {
      soci::transaction transaction(sql);
      action();
      transaction.commit();
      chain->keep();
      return {};
    } catch (const std::exception& exception) {
      chain->forget();
      return failure(subject, reason_of(exception, &sql));
    }
  }

  /// Prepares what runs during a measurement.
  void prepare() {
    statements.emplace(sql);
    chain.emplace(sql);
  }

  void insert(const Touch& touch) {
    require_touch(touch);
    statements->touch = touch;
    statements->purpose = name_of(touch.purpose);
    statements->temperature_degC.take(touch.temperature_degC, "temperature_degC");
    statements->scale_temperature_degC.take(touch.scale_temperature_degC, "scale_temperature_degC");
    statements->insert_touch.execute(true);
    chain->append("touch", touch.id);
  }

  void clear_ending() {
    sql << "update header set ending = '', failure_code = null, failure_what = null, "
           "failure_where = null";
    chain->append("header", 0);
  }

  /// Makes one closed file of the journal and its log.
  core::Result<void> fold() {
    try {
      fold_log(sql);
      statements.reset();
      chain.reset();
      leave_log(sql);
      sql.close();
      state = State::kFolded;
      return {};
    } catch (const std::exception& exception) {  // the digests are safe
      return failure("the folded log", reason_of(exception, &sql));
    }
  }

  void keep(const Touch& touch) {
    last_touch = last_touch ? std::max(*last_touch, touch.id) : touch.id;
  }
};

}  // namespace rondure::record
