#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "core/error.h"
#include "record/run_record.h"

namespace rondure::record {

/// A copy of the journal of a running measurement, for watchers in other threads. The journal adds
/// each row after it is on disk, so that a watcher never sees a row that could still be lost. Every
/// call is safe from any thread; a call of the run waits at most for the copy of the rows that a
/// watcher has not seen yet.
class GrowingRecord {
 public:
  /// Starts, or resumes, with this record. Its header names the version of the measuring program.
  void begin(RunRecord record);
  void add(std::span<const Touch> touches);
  void add(const PoseVisit& pose);
  void add(const Decision& decision);
  void mark_final(int pose_id);
  /// Records the ending of the run; watchers receive nothing after it.
  void end(const std::string& ending, const core::Error* failure);

  /// Updates the watcher's own copy: O(new rows + poses).
  /// @param mine  Default-constructed at first, then changed only by this call.
  /// @return  Whether there was anything new.
  bool catch_up(RunRecord& mine) const;

 private:
  mutable std::mutex mutex_;
  bool begun_ = false;
  RunRecord record_;
};

}  // namespace rondure::record
