#include "record/journal/internal/log.h"

#include <stdexcept>
#include <string>

namespace rondure::record {

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
