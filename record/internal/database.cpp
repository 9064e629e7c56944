#include "record/internal/database.h"

#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "record/files.h"

namespace rondure::record {
namespace {

/// SQLite's own message, without the name of the SOCI function that reported it.
std::string words_of(const soci::soci_error& error) {
  std::string words = error.get_error_message();
  const std::size_t colon = words.find(": ");
  if (words.starts_with("sqlite3_") && colon != std::string::npos) words.erase(0, colon + 2);
  return words;
}

std::string reason_of_constraint(const std::string& words) {
  const std::string column = words.substr(words.rfind(' ') + 1);
  if (words.starts_with("UNIQUE")) return fmt::format("this {} is in the journal already", column);
  if (words.starts_with("NOT NULL")) return fmt::format("{} is not a number (NaN)", column);
  return words;
}

/// The errno of the last failed call on one file of SQLite, 0 for none.
int last_errno_of(sqlite_api::sqlite3_file* file) {
  int number = 0;
  if (file != nullptr && file->pMethods != nullptr) {
    file->pMethods->xFileControl(file, SQLITE_FCNTL_LAST_ERRNO, &number);
  }
  return number;
}

/// The operating system's reason for the last failed call. SQLite stores it in one of three places:
/// the log, the database file, or the connection.
std::string system_reason_of(soci::session* session) {
  constexpr const char* kUnknown = "the disk gave an error; check the disk";
  if (session == nullptr || !session->is_connected()) return kUnknown;
  sqlite_api::sqlite3* const handle = handle_of(*session);
  for (const int which : {SQLITE_FCNTL_JOURNAL_POINTER, SQLITE_FCNTL_FILE_POINTER}) {
    sqlite_api::sqlite3_file* file = nullptr;
    sqlite_api::sqlite3_file_control(handle, "main", which, static_cast<void*>(&file));
    if (const int number = last_errno_of(file); number != 0) return system_reason(number);
  }
  const int number = sqlite_api::sqlite3_system_errno(handle);
  return number == 0 ? kUnknown : system_reason(number);
}

}  // namespace

core::Result<std::string> connection_string(const std::filesystem::path& file) {
  if (file.string().find('"') != std::string::npos) {
    return core::fail(
        core::Code::kFile,
        fmt::format("a database cannot be kept under a path with a double quote ({}); "
                    "name another place",
                    file.string()),
        file.string());
  }
  return fmt::format("dbname=\"{}\" timeout=5", file.string());
}

sqlite_api::sqlite3* handle_of(soci::session& session) {
  return static_cast<soci::sqlite3_session_backend*>(session.get_backend())->conn_;
}

void distrust(soci::session& sql) {
  constexpr std::array<std::pair<int, int>, 4> kSwitches = {{{SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                                             {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                                                             {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                                             {SQLITE_DBCONFIG_DEFENSIVE, 1}}};
  for (const auto& [which, on] : kSwitches) {
    int state = -1;
    sqlite_api::sqlite3_db_config(handle_of(sql), which, on, &state);
    if (state != on) throw soci::soci_error("SQLite does not close the file to its own triggers");
  }
  sql << "pragma cell_size_check = on";
}

std::string reason_of(const std::exception& exception, soci::session* session) {
  const auto* error = dynamic_cast<const soci::sqlite3_soci_error*>(&exception);
  if (error == nullptr) {
    const auto* general = dynamic_cast<const soci::soci_error*>(&exception);
    return general == nullptr ? exception.what() : words_of(*general);
  }
  switch (error->result() & 0xff) {  // the low byte is the kind, the rest is detail
    case SQLITE_FULL:
      return "the disk is full; free space on the disk";
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
      return system_reason_of(session);
    case SQLITE_READONLY:
      return "the file or its directory is read-only; make it writable";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it open; close that program";
    case SQLITE_CORRUPT:
      return fmt::format("it is damaged: {}", words_of(*error));
    case SQLITE_CONSTRAINT:
      return reason_of_constraint(words_of(*error));
    default:
      return words_of(*error);
  }
}

void enable_wal(soci::session& sql) {
  std::string mode;
  sql << "pragma locking_mode = exclusive", soci::into(mode);
  sql << "pragma journal_mode = wal", soci::into(mode);
  if (mode != "wal") throw std::runtime_error("SQLite refuses a write-ahead log (" + mode + ")");
  sql << "pragma synchronous = full";
}

void checkpoint_wal(soci::session& sql) {
  int busy = 0;
  int frames = 0;
  int moved = 0;
  sql << "pragma wal_checkpoint(truncate)", soci::into(busy), soci::into(frames), soci::into(moved);
  if (busy != 0) throw std::runtime_error("another program reads it; close that program");
}

void disable_wal(soci::session& sql) {
  std::string mode;
  sql << "pragma journal_mode = delete", soci::into(mode);
}

}  // namespace rondure::record
