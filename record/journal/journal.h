#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "record/run_lock.h"
#include "record/run_record.h"

namespace rondure::record {

class GrowingRecord;
struct HeldJournal;

/// Name of the journal in a run directory.
inline constexpr const char* kJournalName = "journal.db";

/// The journal of one run: an SQLite file that receives every touch before the next command goes to
/// the machine. Each call is one transaction, on disk (WAL, synchronous=full) when it returns, and
/// each row it writes or changes is linked in a hash chain in the same transaction.
/// It holds the lock of the directory (run_lock.h) until it is destroyed: one process per run. Any
/// call can fail with kJournal (full disk, read-only directory, ...); `what` names the file, the
/// cause in words and the remedy. Schema: docs/developer/journal.md.
class Journal {
 public:
  /// Creates `directory` and the journal in it. An existing directory must be empty. On an error
  /// nothing that was created remains.
  /// @param settings  Settings of the whole run.
  /// @return  kFile also when the directory is not empty or another process is at work in it.
  [[nodiscard]] static core::Result<Journal> create(const std::filesystem::path& directory,
                                                    const Header& header, const Artefact& artefact,
                                                    std::span<const Feature> features,
                                                    std::span<const Setting> settings = {});

  /// Opens the journal of a run that was interrupted, stopped or failed. Rows are added after its
  /// last row, and the chain continues after its last link. The ending of the run is removed from
  /// the header; end() writes the new one. Temporary files of killed writers are removed.
  /// @param held  From hold_journal() for that directory.
  /// @return  kJournal when it does not follow its chain, is sealed or listed in SHA256SUMS; kFile
  ///          when it is a link.
  [[nodiscard]] static core::Result<Journal> reopen(const std::filesystem::path& directory,
                                                    HeldJournal held);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// From now on also adds touches, poses, decisions and the ending to `copy`, each after it is on
  /// disk. The caller first gives `copy` the rows already written (GrowingRecord::begin()).
  void follow(std::shared_ptr<GrowingRecord> copy);

  [[nodiscard]] core::Result<void> add(const Touch& touch);
  /// Adds many touches in one transaction: the rows of a points file.
  [[nodiscard]] core::Result<void> add(std::span<const Touch> touches);
  [[nodiscard]] core::Result<void> add(const PoseVisit& pose);
  [[nodiscard]] core::Result<void> add(const Decision& decision);
  /// Adds the series of one feature with the numbers of its hidden truth, in one transaction.
  /// kJournal also for an invalid series: a value that is not finite, or values that do not fill
  /// the columns.
  [[nodiscard]] core::Result<void> add(std::span<const Series> series,
                                       std::span<const TruthValue> truths);
  /// Marks the pose whose cloud is evaluated.
  [[nodiscard]] core::Result<void> mark_final(int pose_id);
  /// Writes how the run ended; call once, or once again after reopen().
  [[nodiscard]] core::Result<void> end(const std::string& ending, const core::Error* failure);
  /// Stores the numbers of the evaluation and a digest of every table, moves the write-ahead log
  /// into the file, closes it and writes its SHA-256 to SHA256SUMS in the same directory. Nothing
  /// can be added afterwards. When a step fails, a second call continues with that step.
  [[nodiscard]] core::Result<void> seal(std::span<const StoredResult> results);
  /// Completes seal() for a run that died after its commit: moves the log into the file and lists
  /// the digest. Does nothing when the digest is listed already.
  /// @pre  The caller holds the lock of the directory and has read the journal: a journal with
  ///       faults_of() must not get a new digest, and a foreign log must not be moved into it.
  /// @return  Errors of seal() and of read_checksums().
  [[nodiscard]] static core::Result<void> finish_seal(const std::filesystem::path& directory);

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A table that was changed: its rows do not follow the chain, or do not have the digest stored
/// when the journal was closed.
struct BrokenTable {
  std::string table;  ///< e.g. "touch"; "chain" when the links themselves are damaged
  std::string what;   ///< e.g. "199 rows, expected 200: touch 7 was removed after it was written"
};

/// A journal read back.
struct ReadJournal {
  RunRecord record;
  std::vector<BrokenTable> broken;  ///< Empty for an intact journal, sealed or not.
  bool listed = false;              ///< SHA256SUMS names it: its run closed it.
  bool as_listed = true;            ///< Its bytes have the digest in SHA256SUMS, if listed there.
  /// Logs beside a closed journal that would change it, by name. They were not read.
  std::vector<std::string> beside;
};

/// Reads `directory`/journal.db without changing it. A closed journal (listed in SHA256SUMS, or
/// whole and sealed without its log) is read from that file alone, an open or interrupted one
/// together with its log. Nothing stored in the file is executed. kFile when there is none,
/// kJournal when it is not a journal of Rondure, has tables of another version or is damaged;
/// `where` names the file.
[[nodiscard]] core::Result<ReadJournal> read_journal(const std::filesystem::path& directory);

/// A journal that no other process can change: it was read after its directory was locked.
struct HeldJournal {
  RunLock lock;
  ReadJournal read;
};

/// Locks a run directory, then reads its journal. kFile also when another process is at work in it;
/// other errors as read_journal().
[[nodiscard]] core::Result<HeldJournal> hold_journal(const std::filesystem::path& directory);

/// The reasons not to evaluate a journal, one sentence each: changed tables, bytes that differ from
/// the digest in SHA256SUMS, logs beside it. Empty for an intact one.
[[nodiscard]] std::vector<std::string> faults_of(const ReadJournal& journal);

/// Whether no data of a run have been written to a directory yet: it is absent, empty, or holds a
/// journal without tables, whose creation was interrupted. Removes such a leftover, so that the run
/// can start there.
/// @return  false in every other case; kFile when another process is at work in the directory, or
///          when it cannot be read.
[[nodiscard]] core::Result<bool> clear_unstarted_run(const std::filesystem::path& directory);

}  // namespace rondure::record
