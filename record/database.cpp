#include "record/database.h"

#include <bit>
#include <memory>

#include <fmt/format.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/files.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

using Statement =
    std::unique_ptr<sqlite_api::sqlite3_stmt, decltype(&sqlite_api::sqlite3_finalize)>;

sqlite_api::sqlite3* handle_of(soci::session& session) {
  return static_cast<soci::sqlite3_session_backend*>(session.get_backend())->conn_;
}

/// SQLite's own words, without the name of the function in SOCI that passed them on.
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

/// The operating system's number for the last failed call on one file of SQLite's, 0 for none.
int last_errno_of(sqlite_api::sqlite3_file* file) {
  int number = 0;
  if (file != nullptr && file->pMethods != nullptr) {
    file->pMethods->xFileControl(file, SQLITE_FCNTL_LAST_ERRNO, &number);
  }
  return number;
}

/// The operating system's reason for the last failed call. SQLite remembers it in one of three
/// places: at the log, at the database file, or at the connection.
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

/// Appends the eight bytes of a number, lowest first, on every kind of processor.
void append_number(std::string& bytes, std::uint64_t number) {
  for (unsigned shift = 0; shift < 64; shift += 8) {
    bytes += static_cast<char>((number >> shift) & 0xffU);
  }
}

/// Appends the canonical bytes of one value: a letter for its type, then the value.
void append_value(std::string& bytes, sqlite_api::sqlite3_stmt* row, int column) {
  switch (sqlite_api::sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
      bytes += 'i';
      append_number(bytes,
                    static_cast<std::uint64_t>(sqlite_api::sqlite3_column_int64(row, column)));
      break;
    case SQLITE_FLOAT:
      bytes += 'r';
      append_number(bytes,
                    std::bit_cast<std::uint64_t>(sqlite_api::sqlite3_column_double(row, column)));
      break;
    case SQLITE_NULL:
      bytes += 'n';
      break;
    default: {  // text; the schema knows no other type
      const void* text = sqlite_api::sqlite3_column_blob(row, column);
      const auto size = static_cast<std::size_t>(sqlite_api::sqlite3_column_bytes(row, column));
      bytes += 't';
      append_number(bytes, size);
      if (size > 0) bytes.append(static_cast<const char*>(text), size);
    }
  }
}

}  // namespace

core::Result<std::string> connection_string(const std::filesystem::path& file) {
  if (file.string().find('"') != std::string::npos) {
    return core::fail(core::Code::kFile,
                      fmt::format("a database cannot be kept under a path with a double quote ({}); "
                                  "name another place",
                                  file.string()),
                      file.string());
  }
  return fmt::format("dbname=\"{}\" timeout=5", file.string());
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
    case SQLITE_CONSTRAINT:
      return reason_of_constraint(words_of(*error));
    default:
      return words_of(*error);
  }
}

Digest digest_of(soci::session& session, std::string_view table) {
  sqlite_api::sqlite3* const handle = handle_of(session);
  const std::string query = fmt::format("select * from {} order by 1", table);
  sqlite_api::sqlite3_stmt* raw = nullptr;
  int state = sqlite_api::sqlite3_prepare_v2(handle, query.c_str(), -1, &raw, nullptr);
  const Statement row(raw, &sqlite_api::sqlite3_finalize);
  Digest digest;
  Sha256 hash;
  std::string bytes;
  const int columns = sqlite_api::sqlite3_column_count(raw);
  while (state == SQLITE_OK && (state = sqlite_api::sqlite3_step(raw)) == SQLITE_ROW) {
    bytes.clear();
    for (int column = 0; column < columns; ++column) append_value(bytes, raw, column);
    hash.add(bytes);
    ++digest.rows;
    state = SQLITE_OK;
  }
  if (state != SQLITE_DONE) {
    throw soci::sqlite3_soci_error(sqlite_api::sqlite3_errmsg(handle), state);
  }
  digest.sha256 = hash.hex();
  return digest;
}

}  // namespace rondure::record
