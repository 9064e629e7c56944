#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::record {

/// Name of the journal in a run directory.
inline constexpr const char* kJournalName = "journal.db";

/// The journal of one run: an SQLite file that receives every touch before the next command goes to
/// the machine. Each call is one transaction, on disk (WAL, synchronous=full) when it returns.
/// While it lives it holds the lock of the directory (run_lock.h): one process a run.
/// Any call can fail with kJournal (full disk, read-only directory, ...); `what` names the file,
/// the cause in words and what to do. Schema: docs/journal.md.
class Journal {
 public:
  /// Makes `directory` and the journal in it. The directory may exist when it is empty; otherwise
  /// kFile, also when another process is at work there. Nothing is left behind when this fails.
  [[nodiscard]] static core::Result<Journal> create(const std::filesystem::path& directory,
                                                    const Header& header, const Artefact& artefact,
                                                    std::span<const Feature> features);

  /// Opens the journal of a run that was interrupted, stopped or failed, to go on behind its last
  /// row. What ended the run before is taken out of the header (end() writes the new ending); what
  /// a killed writer of reports left behind is removed. kFile when there is no journal or another
  /// process is at work in the directory; kJournal when it cannot be read or is sealed. Read the
  /// rows with read_journal().
  [[nodiscard]] static core::Result<Journal> reopen(const std::filesystem::path& directory);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  [[nodiscard]] core::Result<void> add(const Touch& touch);
  /// Many touches in one transaction: rows of a points file.
  [[nodiscard]] core::Result<void> add(std::span<const Touch> touches);
  [[nodiscard]] core::Result<void> add(const PoseVisit& pose);
  [[nodiscard]] core::Result<void> add(const Decision& decision);
  [[nodiscard]] core::Result<void> add(const SimulationTruth& truth);
  /// Marks the pose whose cloud is evaluated.
  [[nodiscard]] core::Result<void> mark_final(int pose_id);
  /// Writes how the run ended; call once, or once again after reopen().
  [[nodiscard]] core::Result<void> end(const std::string& ending, const core::Error* failure);
  /// Stores the numbers of the evaluation and a digest of every table, then folds the write-ahead
  /// log into the one file. The journal takes nothing more afterwards.
  [[nodiscard]] core::Result<void> seal(std::span<const StoredResult> results);

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A table of a sealed journal whose rows no longer give the digest stored when it was closed.
struct BrokenTable {
  std::string table;  ///< e.g. "touch"
  std::string what;   ///< e.g. "232 rows, expected 233" or "a value differs from the sealed one"
};

/// A journal read back.
struct ReadJournal {
  RunRecord record;
  std::vector<BrokenTable> broken;  ///< Empty for an intact journal.
};

/// Reads `directory`/journal.db without changing it. kFile when there is none, kJournal when it is
/// not a journal of ours or damaged; `where` names the file.
[[nodiscard]] core::Result<ReadJournal> read_journal(const std::filesystem::path& directory);

}  // namespace rondure::record
