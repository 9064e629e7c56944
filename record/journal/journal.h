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
/// While it lives it holds the lock of the directory (run_lock.h): one process a run.
/// Any call can fail with kJournal (full disk, read-only directory, ...); `what` names the file,
/// the cause in words and what to do. Schema: docs/journal.md.
class Journal {
 public:
  /// Makes `directory` and the journal in it. The directory may exist when it is empty; otherwise
  /// kFile, also when another process is at work there. Nothing is left behind when this fails.
  /// @param settings  Of the whole run.
  [[nodiscard]] static core::Result<Journal> create(const std::filesystem::path& directory,
                                                    const Header& header, const Artefact& artefact,
                                                    std::span<const Feature> features,
                                                    std::span<const Setting> settings = {});

  /// Opens the journal of a run that was interrupted, stopped or failed, to go on after its last
  /// row; the chain goes on after its last link. The ending of the run is taken out of the header
  /// (end() writes the new one); what a killed writer of reports left there is removed. A journal
  /// of version 5 stays one: its decisions are written as sentences.
  /// @param held  As hold_journal() gave it for that directory.
  /// @return  kJournal when it does not follow its chain, is sealed, listed, a link or of an older
  ///          version.
  [[nodiscard]] static core::Result<Journal> reopen(const std::filesystem::path& directory,
                                                    HeldJournal held);
  /// The same with hold_journal(), for who does not need the rows.
  [[nodiscard]] static core::Result<Journal> reopen(const std::filesystem::path& directory);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// From now on touches, poses, decisions and the end are added there as well, each after it is on
  /// disk. Whoever calls gives the copy what stands in the journal already (GrowingRecord::begin).
  void follow(std::shared_ptr<GrowingRecord> copy);

  [[nodiscard]] core::Result<void> add(const Touch& touch);
  /// Many touches in one transaction: rows of a points file.
  [[nodiscard]] core::Result<void> add(std::span<const Touch> touches);
  [[nodiscard]] core::Result<void> add(const PoseVisit& pose);
  [[nodiscard]] core::Result<void> add(const Decision& decision);
  [[nodiscard]] core::Result<void> add(const SimulationTruth& truth);
  /// The series of one feature with the numbers of its hidden truth, in one transaction: after a
  /// kill all of it is there or nothing. kJournal also for a series that is none: a value that is
  /// not finite, values that do not fill the columns.
  [[nodiscard]] core::Result<void> add(std::span<const Series> series,
                                       std::span<const TruthValue> truths);
  /// Marks the pose whose cloud is evaluated.
  [[nodiscard]] core::Result<void> mark_final(int pose_id);
  /// Writes how the run ended; call once, or once again after reopen().
  [[nodiscard]] core::Result<void> end(const std::string& ending, const core::Error* failure);
  /// Stores the numbers of the evaluation and a digest of every table, folds the write-ahead log
  /// into the one file, closes it and writes its SHA-256 into SHA256SUMS beside it. The journal
  /// takes nothing more afterwards. When a step fails, a second call goes on with it.
  [[nodiscard]] core::Result<void> seal(std::span<const StoredResult> results);
  /// Finishes what seal() does behind its commit, for a run that died there: folds the log and
  /// lists the digest. A journal whose digest is listed is left alone. Hold the lock of the
  /// directory, and read the journal before: one with faults_of() must not get a new digest, nor
  /// a foreign log be folded. Errors as of seal(), and of read_checksums().
  [[nodiscard]] static core::Result<void> finish_seal(const std::filesystem::path& directory);

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A table whose rows are not those that were written: they no longer follow the chain, or no
/// longer give the digest stored when the journal was closed.
struct BrokenTable {
  std::string table;  ///< e.g. "touch"; "chain" when the links themselves are damaged
  std::string what;   ///< e.g. "199 rows, expected 200: touch 7 was removed after it was written"
};

/// A journal read back.
struct ReadJournal {
  RunRecord record;
  std::vector<BrokenTable> broken;  ///< Empty for an intact journal, sealed or not.
  int version = 0;                  ///< Of its tables; 1 has no chain.
  bool listed = false;              ///< SHA256SUMS names it: its run closed it.
  bool as_listed = true;            ///< Its bytes have the digest there, where it is listed.
  /// Logs beside a closed journal that would change it, by name. They were not read.
  std::vector<std::string> beside;
};

/// Reads `directory`/journal.db without changing it: a journal that its run closed (it is listed in
/// SHA256SUMS, or is whole and sealed by itself) from that file alone, one that is open or was
/// interrupted together with its log. Nothing that stands in the file is run. kFile when there is
/// none, kJournal when it is not a journal of ours or damaged; `where` names the file.
[[nodiscard]] core::Result<ReadJournal> read_journal(const std::filesystem::path& directory);

/// A journal that nobody else can change: it was read after the lock of its directory was taken.
struct HeldJournal {
  RunLock lock;
  ReadJournal read;
};

/// Takes the lock of a run directory, then reads its journal. kFile also when another process is at
/// work there; otherwise as read_journal().
[[nodiscard]] core::Result<HeldJournal> hold_journal(const std::filesystem::path& directory);

/// Why nothing should be computed from a journal, one sentence each: tables that were changed,
/// bytes that are not those of its list, logs beside it. Empty for a sound one.
[[nodiscard]] std::vector<std::string> faults_of(const ReadJournal& journal);

/// Whether nothing of a run has reached a directory yet: it is absent, empty, or holds a journal
/// without tables, whose making was interrupted. Such a remainder is removed, so that the run can
/// begin there.
/// @return  false for everything else; kFile when another process is at work in the directory, or
///          it cannot be looked at.
[[nodiscard]] core::Result<bool> clear_unstarted_run(const std::filesystem::path& directory);

}  // namespace rondure::record
