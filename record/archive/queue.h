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

/// Runs that could not be pushed yet: a file of SQLite with the tables of an archive and a list of
/// which run waits for which archive. Several programs may use it at a time. Every call can fail
/// as those of Archive.
class ArchiveQueue {
 public:
  /// Opens the queue; makes the file when it is not there.
  [[nodiscard]] static core::Result<ArchiveQueue> open(const std::filesystem::path& file);

  ArchiveQueue(ArchiveQueue&&) noexcept;
  ArchiveQueue& operator=(ArchiveQueue&&) noexcept;
  ~ArchiveQueue();

  /// Lets `run` wait for `target`: ArchivePlace::key of an archive. Twice is once.
  [[nodiscard]] core::Result<void> add(const std::string& target, const ArchiveRun& run);
  /// The archives for which runs wait.
  [[nodiscard]] core::Result<std::vector<std::string>> targets();
  /// How many runs wait for `target`.
  [[nodiscard]] core::Result<std::size_t> size(const std::string& target);
  /// The run that waits longest for `target`, or nothing.
  [[nodiscard]] core::Result<std::optional<ArchiveRun>> first(const std::string& target);
  /// The run has arrived, and waits no more.
  [[nodiscard]] core::Result<void> remove(const std::string& target, const ArchiveRun& run);

 private:
  struct Impl;
  explicit ArchiveQueue(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// How long a delivery tries.
struct DeliveryOptions {
  int attempts = 3;              ///< For one run; >= 1.
  double pause_s = 0.3;          ///< Before the second attempt; doubles from one to the next.
  double give_up_after_s = 5.0;  ///< No new attempt, and no further run of the queue, after it [s].
  std::function<bool()> stop_requested = {};  ///< Asked before every attempt; may be empty.
};

/// What became of a delivery.
struct Delivery {
  std::size_t sent = 0;     ///< Runs that are in the archive now, and that were not before.
  std::size_t results = 0;  ///< Results of those.
  std::size_t waiting = 0;  ///< Runs that wait in the queue for this archive.
  bool known = false;       ///< The archive held the run before.
  std::optional<core::Error> failure;        ///< Why the archive did not take everything.
  std::optional<core::Error> queue_failure;  ///< Why the queue did not take it either.
};

/// Pushes `run` and what waits for the same archive. What the archive does not take waits in the
/// queue, whose file is made only when it is needed.
///
/// @param run  May be null: only what waits.
[[nodiscard]] Delivery deliver(const ArchivePlace& place, const std::filesystem::path& queue_file,
                               const ArchiveRun* run, const DeliveryOptions& options);

}  // namespace rondure::record
