#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/internal/database.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/rows.h"
#include "record/journal/internal/values.h"
#include "record/journal/journal.h"
#include "record/journal/message_text.h"
#include "record/run_lock.h"

// Private to the room: the open journal. open.cpp creates it, write.cpp writes rows and seals it.

namespace rondure::record {

/// kFile when the file of a journal is a link: SQLite would write where it leads, and keep the log
/// there.
[[nodiscard]] core::Result<void> require_no_link(const std::filesystem::path& journal);

struct Journal::Impl {
  enum class State { kOpen, kDigested, kOneFile, kClosed };

  /// Declared before the session, so that it is released after the journal is closed.
  RunLock lock;
  std::filesystem::path file;
  soci::session sql;
  std::optional<Statements> statements;
  std::optional<Chain> chain;
  std::optional<std::int64_t> last_touch;
  Header header;                   ///< Header and poses as given: these rows change later.
  std::map<int, PoseVisit> poses;  ///< By id.
  bool ended = false;
  std::uintmax_t log_bytes = 0;  ///< Of the write-ahead log after the last transaction.
  State state = State::kOpen;
  std::shared_ptr<GrowingRecord> follower;  ///< May be null.

  Impl(RunLock taken, std::filesystem::path path, const std::string& connection)
      : lock(std::move(taken)), file(std::move(path)), sql(soci::sqlite3, connection) {
    distrust(sql);
  }

  /// The error "`subject` cannot be written", with the touches that are safe.
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
    if (const std::uintmax_t left = bytes_of_log(); left < log_bytes) return cut_log(subject, left);
    try {
      soci::transaction transaction(sql);
      action();
      transaction.commit();
      chain->commit();
      log_bytes = bytes_of_log();
      return {};
    } catch (const std::exception& exception) {
      chain->roll_back();
      return failure(subject, reason_of(exception, &sql));
    }
  }

  /// Prepares the statements that run during a measurement.
  void prepare() {
    statements.emplace(sql);
    chain.emplace(sql);
    log_bytes = bytes_of_log();
  }

  [[nodiscard]] std::uintmax_t bytes_of_log() const {
    std::error_code none;
    const std::uintmax_t bytes = std::filesystem::file_size(file.string() + "-wal", none);
    return none ? 0 : bytes;
  }

  /// The error after another program has cut the log. SQLite, which does not look, would move its
  /// holes into the journal when it closes.
  tl::unexpected<core::Error> cut_log(std::string_view subject, std::uintmax_t left) {
    int state_now = 0;
    sqlite_api::sqlite3_db_config(handle_of(sql), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, &state_now);
    return core::fail(
        core::Code::kJournal,
        fmt::format("{} cannot be written to {}: another program cut its log, {}-wal, from {} to "
                    "{} bytes; the touches in it are lost, those before them are kept",
                    subject, file.string(), kJournalName, log_bytes, left));
  }

  void insert(const Touch& touch) {
    require_touch(touch);
    statements->touch = touch;
    statements->purpose = name_of(touch.purpose);
    statements->temperature_degC.take(touch.temperature_degC, "temperature_degC");
    statements->scale_temperature_degC.take(touch.scale_temperature_degC, "scale_temperature_degC");
    statements->insert_touch.execute(true);
    chain->append("touch", touch.id, statements->purpose, touch.pose, touch.layer, touch.point,
                  touch.repeat, touch.tip_mm.x(), touch.tip_mm.y(), touch.tip_mm.z(),
                  touch.approach.x(), touch.approach.y(), touch.approach.z(),
                  touch.temperature_degC, touch.time_s, touch.scale_temperature_degC);
  }

  void insert(const Decision& decision) {
    Statements& s = *statements;
    s.decision = decision;
    s.decision_code = core::message_name(decision.message.code);
    s.decision_arguments = arguments_json(decision.message);
    s.insert_decision.execute(true);
    chain->append_inserted("decision", decision.feature, decision.time_s, s.decision_code,
                           s.decision_arguments);
  }

  void link(const PoseVisit& pose) {
    chain->append("pose", pose.id, pose.feature, pose.commanded.alpha_rad, pose.commanded.beta_rad,
                  pose.reached.alpha_rad, pose.reached.beta_rad, pose.final_cloud ? 1 : 0,
                  pose.time_s);
  }

  void link_header(const std::string& ending, const core::Error* failure) {
    const Header& h = header;
    const auto of_failure = [&](const std::string& text) {
      return failure == nullptr ? std::optional<std::string>() : std::optional(text);
    };
    const core::Error none;
    const core::Error& why = failure == nullptr ? none : *failure;
    chain->append("header", 0, h.run_id, h.version, h.processor, h.started_utc, h.plan_file,
                  h.plan_name, h.plan_revision, h.plan_text, h.plan_sha256, h.part_id, h.part_name,
                  h.drawing, h.serial, h.operator_name, h.machine, h.fixture, h.decision_rule,
                  h.simulated ? 1 : 0, std::to_string(h.seed), h.temperature_min_degC,
                  h.temperature_max_degC, ending,
                  of_failure(std::string(core::code_name(why.code))), of_failure(why.what),
                  of_failure(why.where));
  }

  void clear_ending() {
    sql << "update header set ending = '', failure_code = null, failure_what = null, "
           "failure_where = null";
    link_header("", nullptr);
  }

  /// Moves the log into the journal, so that one closed file remains.
  core::Result<void> leave_wal() {
    try {
      checkpoint_wal(sql);
      statements.reset();
      chain.reset();
      disable_wal(sql);
      sql.close();
      state = State::kOneFile;
      return {};
    } catch (const std::exception& exception) {  // the digests are on disk already
      return failure("the folded log", reason_of(exception, &sql));
    }
  }

  void note_touch(const Touch& touch) {
    last_touch = last_touch ? std::max(*last_touch, touch.id) : touch.id;
  }
};

}  // namespace rondure::record
