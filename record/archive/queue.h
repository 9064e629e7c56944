#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "record/archive/archive.h"

namespace rondure::record {

/// Runs that could not be pushed yet: an SQLite file with the tables of an archive and a list that
/// assigns each run to the archive it waits for. Several programs may use it at a time. Every call
/// can fail as those of Archive.
class ArchiveQueue {
 public:
  /// Opens the queue; creates the file when it does not exist.
  [[nodiscard]] static core::Result<ArchiveQueue> open(const std::filesystem::path& file);

  ArchiveQueue(ArchiveQueue&&) noexcept;
  ArchiveQueue& operator=(ArchiveQueue&&) noexcept;
  ~ArchiveQueue();

  /// Adds `run` to the queue for `target`, the ArchivePlace::key of an archive. Adding it again
  /// changes nothing.
  [[nodiscard]] core::Result<void> add(const std::string& target, const ArchiveRun& run);
  /// The archives for which runs are queued.
  [[nodiscard]] core::Result<std::vector<std::string>> targets();
  /// Number of runs queued for `target`.
  [[nodiscard]] core::Result<std::size_t> size(const std::string& target);
  /// The run that has waited longest for `target`, or nothing.
  [[nodiscard]] core::Result<std::optional<ArchiveRun>> first(const std::string& target);
  /// Removes a run that has reached `target`.
  [[nodiscard]] core::Result<void> remove(const std::string& target, const ArchiveRun& run);

 private:
  explicit ArchiveQueue(std::unique_ptr<ArchiveSession> session);
  std::unique_ptr<ArchiveSession> session_;
};

/// Limits of a delivery.
struct DeliveryOptions {
  int attempts = 3;              ///< For one run; >= 1.
  double pause_s = 0.3;          ///< Pause before the second attempt [s]; doubles each time.
  double give_up_after_s = 5.0;  ///< No attempt and no further run after this time.
  std::function<bool()> stop_requested = {};  ///< Called before every attempt; may be empty.
};

/// Result of a delivery.
struct Delivery {
  std::size_t sent = 0;                      ///< Runs added to the archive.
  std::size_t results = 0;                   ///< Results of these runs.
  std::size_t waiting = 0;                   ///< Runs still queued for this archive.
  bool known = false;                        ///< The archive already held the run.
  std::optional<core::Error> failure;        ///< Why the archive did not take all runs.
  std::optional<core::Error> queue_failure;  ///< Why a run could not be queued either.
};

/// Pushes `run` and the runs queued for the same archive. A run that the archive does not take is
/// queued; the queue file is created only then.
///
/// @param run  May be null: pushes only the queued runs.
[[nodiscard]] Delivery deliver(const ArchivePlace& place, const std::filesystem::path& queue_file,
                               const ArchiveRun* run, const DeliveryOptions& options);

}  // namespace rondure::record
