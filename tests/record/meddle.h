#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>

namespace rondure::record {

/// Runs SQL on a journal file, without the journal code.
inline void meddle(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  char* problem = nullptr;
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &problem), SQLITE_OK) << problem;
  sqlite3_free(problem);
  sqlite3_close(database);
}

/// The bytes of a write-ahead log that gives `journal` the contents of `other`, when it lies beside
/// it: whole pages, each with its checksum.
inline std::string log_that_replaces(const std::filesystem::path& journal,
                                     const std::filesystem::path& other) {
  const std::string copy = journal.string() + ".copy";
  std::filesystem::copy_file(journal, copy);
  sqlite3* to = nullptr;
  sqlite3* from = nullptr;
  EXPECT_EQ(sqlite3_open(copy.c_str(), &to), SQLITE_OK);
  EXPECT_EQ(sqlite3_open(other.c_str(), &from), SQLITE_OK);
  sqlite3_exec(to, "pragma journal_mode = wal; pragma wal_autocheckpoint = 0", nullptr, nullptr,
               nullptr);
  sqlite3_backup* const pages = sqlite3_backup_init(to, "main", from, "main");
  EXPECT_EQ(sqlite3_backup_step(pages, -1), SQLITE_DONE);
  sqlite3_backup_finish(pages);
  std::ostringstream bytes;
  bytes << std::ifstream(copy + "-wal", std::ios::binary).rdbuf();
  sqlite3_close(from);
  sqlite3_close(to);
  for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(copy + suffix);
  return bytes.str();
}

/// The bytes of a rollback journal with the pages of `other`. SQLite restores them into a journal
/// as its own state before an interrupted change.
inline std::string rollback_to(const std::filesystem::path& other) {
  const std::string copy = other.string() + ".copy";
  std::filesystem::copy_file(other, copy);
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(copy.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database,
               "pragma synchronous = off; begin; update header set serial = 'x'; update "
               "characteristic set drawing_zone = 'x'; update touch set layer = 1",
               nullptr, nullptr, nullptr);
  std::ostringstream bytes;
  bytes << std::ifstream(copy + "-journal", std::ios::binary).rdbuf();
  sqlite3_close(database);
  std::filesystem::remove(copy);
  return bytes.str();
}

}  // namespace rondure::record
