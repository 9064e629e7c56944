#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "core/error.h"
#include "record/run_record.h"

namespace rondure::record {

/// What the journal of a run at work holds, for whoever watches from another thread. The journal
/// adds each row after it is on disk: what is seen here is never more than what is kept. Every call
/// is safe from any thread; a call of the run waits for nothing but the copy of what a watcher has
/// not seen yet.
class GrowingRecord {
 public:
  /// The run begins, or goes on, with this on record. Its header names the version that measures.
  void begin(RunRecord record);
  void add(std::span<const Touch> touches);
  void add(const PoseVisit& pose);
  void add(const Decision& decision);
  void mark_final(int pose_id);
  /// The run ended so; a watcher sees no more of it.
  void end(const std::string& ending, const core::Error* failure);

  /// Brings the watcher's own copy up to date: O(what it has not seen), and the poses.
  /// @param mine  Default-made at first, then only changed by this call.
  /// @return  Whether there was anything new.
  bool catch_up(RunRecord& mine) const;

 private:
  mutable std::mutex mutex_;
  bool begun_ = false;
  RunRecord record_;
};

}  // namespace rondure::record
