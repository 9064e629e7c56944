#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/archive/place.h"

namespace rondure::record {

struct ArchiveSession;

/// Version of the archive's tables; increases with every change (docs/archive.md).
inline constexpr int kArchiveVersion = 2;

/// Data of a run that all its results share.
struct ArchiveHead {
  std::string journal_sha256;  ///< SHA-256 of the sealed journal.db: the key of a run.
  std::string run_id;
  std::string started_utc;  ///< "2026-11-21T02:33:02Z".
  std::string part_id;
  std::string part_name;
  std::string serial;
  std::string operator_name;
  std::string machine;
  std::string fixture;
  bool simulated = false;
  std::string plan_name;
  std::string plan_revision;
  std::string plan_sha256;
  std::string version;  ///< core::kVersion of the program that measured.
};

/// The result of one characteristic.
struct ArchiveResult {
  std::string feature;
  std::string characteristic;
  std::string symbol;                 ///< "CYLt", "RONt".
  std::string reference;              ///< "MZCY", "LSCI", ...
  std::string filter;                 ///< "unfiltered".
  std::string sampling;               ///< "4 x 7 points; mean of 5 touches per point".
  std::optional<double> value;        ///< Value in `unit`; empty when it could not be evaluated.
  std::optional<double> upper_limit;  ///< Limit in `unit`; empty without an upper limit.
  std::string unit = "mm";
  std::string verdict;  ///< "conforms", "does not conform", "undecided", "void", "not toleranced".
  std::string certificate;  ///< Certificate of the reference: "global", "local", "none".
  std::optional<double> lower_limit = {};  ///< Limit in `unit`; empty without a lower limit.
};

/// A finished run to be archived.
struct ArchiveRun {
  ArchiveHead head;
  std::vector<ArchiveResult> results;
};

/// A result read from the archive.
struct ArchivedResult {
  ArchiveHead head;
  ArchiveResult result;
  std::int64_t time_s = 0;  ///< Start of the run, seconds since 1970.
  std::int64_t run = 0;     ///< Number of the run in this archive.
  int number = 0;           ///< Index of the result in its run, from 0.
};

/// Selects results; a member without a value matches every result.
struct ArchiveFilter {
  std::optional<std::string> part = {};
  std::optional<std::string> feature = {};
  std::optional<std::string> characteristic = {};
  std::optional<std::string> machine = {};
  std::optional<std::string> operator_name = {};
  std::optional<std::string> serial = {};
  std::optional<std::string> verdict = {};
  std::optional<std::int64_t> since_s = {};  ///< Started then or later.
  std::optional<std::int64_t> until_s = {};  ///< Started then or earlier.
};

/// Results of finished runs, in an SQLite file or on a PostgreSQL server. Several programs may use
/// one archive at a time. Every call can fail with kArchive (server gone, file read-only, disk
/// full); a call that fails has written nothing.
class Archive {
 public:
  enum class Access { kRead, kWrite };

  /// Opens an archive; kWrite creates the tables when there are none. Gives up after 5 s on a
  /// server that does not answer. kFile when there is no archive, when the file is something else,
  /// or when its tables have another version; kArchive when it cannot be reached.
  [[nodiscard]] static core::Result<Archive> open(const ArchivePlace& place, Access access);

  Archive(Archive&&) noexcept;
  Archive& operator=(Archive&&) noexcept;
  ~Archive();

  /// Adds a run with all its results, in one transaction. A run that the archive already holds
  /// (same journal_sha256) is left unchanged.
  /// @return Whether the run was new. kBadOption for a time that is not UTC.
  [[nodiscard]] core::Result<bool> push(const ArchiveRun& run);

  /// The newest results that pass the filter, newest first, at most `count`.
  /// @param before  Returns only results older than this one: the next page after an earlier call.
  [[nodiscard]] core::Result<std::vector<ArchivedResult>> newest(
      const ArchiveFilter& filter, std::size_t count, const ArchivedResult* before = nullptr);

 private:
  explicit Archive(std::unique_ptr<ArchiveSession> session);
  std::unique_ptr<ArchiveSession> session_;
};

/// Seconds since 1970 of "2026-11-21T02:33:02Z", or of "2026-11-21" (its first second); nothing for
/// any other text or a day that does not exist.
[[nodiscard]] std::optional<std::int64_t> seconds_of_utc(std::string_view text);

}  // namespace rondure::record
