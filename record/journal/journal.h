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
/// An open journal holds the lock of the directory (run_lock.h): one process per run.
/// Any call can fail with kJournal (full disk, read-only directory, ...); `what` names the file,
/// the cause in words and what to do. Schema: docs/journal.md.
class Journal {
 public:
  /// Creates `directory` and the journal in it. The directory may exist when it is empty; otherwise
  /// kFile, also when another process uses it. A call that fails leaves no files.
  /// @param settings  Settings of the whole run.
  [[nodiscard]] static core::Result<Journal> create(const std::filesystem::path& directory,
                                                    const Header& header, const Artefact& artefact,
                                                    std::span<const Feature> features,
                                                    std::span<const Setting> settings = {});

  /// Opens the journal of a run that was interrupted, stopped or failed, to append to it; the chain
  /// continues after its last link. The earlier ending is removed from the header (end() writes the
  /// new one), and so are temporary files of a killed report writer. kFile when there is no journal
  /// or another process uses the directory; kJournal when the journal cannot be read, does not
  /// match its chain, is sealed, is listed in SHA256SUMS, is a link, or has an older version. Read
  /// the rows with read_journal().
  [[nodiscard]] static core::Result<Journal> reopen(const std::filesystem::path& directory);

  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// From now on also adds touches, poses, decisions and the ending to `copy`, each after it is on
  /// disk. The caller fills the copy with the rows already in the journal (GrowingRecord::begin).
  void follow(std::shared_ptr<GrowingRecord> copy);

  [[nodiscard]] core::Result<void> add(const Touch& touch);
  /// Many touches in one transaction: rows of a points file.
  [[nodiscard]] core::Result<void> add(std::span<const Touch> touches);
  [[nodiscard]] core::Result<void> add(const PoseVisit& pose);
  [[nodiscard]] core::Result<void> add(const Decision& decision);
  [[nodiscard]] core::Result<void> add(const SimulationTruth& truth);
  /// Adds the series of one feature and the numbers of its hidden truth, in one transaction: after
  /// a kill all of it is stored or nothing. kJournal also for an invalid series: a value that is
  /// not finite, values that do not fill the columns.
  [[nodiscard]] core::Result<void> add(std::span<const Series> series,
                                       std::span<const TruthValue> truths);
  /// Marks the pose whose cloud is evaluated.
  [[nodiscard]] core::Result<void> mark_final(int pose_id);
  /// Writes how the run ended; call once, or once again after reopen().
  [[nodiscard]] core::Result<void> end(const std::string& ending, const core::Error* failure);
  /// Stores the numbers of the evaluation and a digest of every table, folds the write-ahead log
  /// into the journal file, closes it and writes its SHA-256 into SHA256SUMS beside it. Further
  /// writes are refused. When a step fails, a second call resumes at that step.
  [[nodiscard]] core::Result<void> seal(std::span<const StoredResult> results);
  /// Finishes a seal() that was interrupted after its commit: folds the log and lists the digest. A
  /// journal whose digest is listed is left unchanged.
  /// @pre The caller holds the lock of the directory and has read the journal. A journal with
  /// faults_of() must not get a new digest, and a foreign log must not be folded. Errors as of
  /// seal() and read_checksums().
  [[nodiscard]] static core::Result<void> finish_seal(const std::filesystem::path& directory);

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A table whose rows are not those that were written: they no longer match the chain, or the
/// digest stored when the journal was closed.
struct BrokenTable {
  std::string table;  ///< e.g. "touch"; "chain" when the links themselves are damaged
  std::string what;   ///< e.g. "199 rows, expected 200: touch 7 was removed after it was written"
};

/// A journal read back.
struct ReadJournal {
  RunRecord record;
  std::vector<BrokenTable> broken;  ///< Empty for an intact journal, sealed or not.
  int version = 0;                  ///< Version of its tables; 1 has no chain.
  bool listed = false;              ///< SHA256SUMS names it: its run closed it.
  bool as_listed = true;            ///< Where it is listed: its bytes match the listed digest.
  /// Names of logs beside a closed journal that would change it. They were not read.
  std::vector<std::string> beside;
};

/// Reads `directory`/journal.db without changing it. A journal that its run closed (it is listed in
/// SHA256SUMS, or is whole and sealed by itself) is read from that file alone, an open or
/// interrupted one together with its log. Nothing stored in the file is executed. kFile when there
/// is none, kJournal when it is damaged or not a journal of Rondure; `where` names the file.
[[nodiscard]] core::Result<ReadJournal> read_journal(const std::filesystem::path& directory);

/// The reasons why a journal must not be evaluated, one sentence each: changed tables, bytes that
/// do not match the listed digest, logs beside it. Empty for a sound one.
[[nodiscard]] std::vector<std::string> faults_of(const ReadJournal& journal);

}  // namespace rondure::record
