#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/run_record.h"
#include "reports/history/earlier_results.h"

namespace rondure::reports {

/// State of the files of a run directory relative to the digests in SHA256SUMS.
struct ListedFiles {
  enum class State { kAsWritten, kChanged, kAbsent };

  bool list_found = false;             ///< There is a SHA256SUMS.
  std::map<std::string, State> files;  ///< The files that it names.

  /// State of a file; none when the list does not name it.
  [[nodiscard]] std::optional<State> state_of(const std::string& file) const;
};

/// Whether a directory has an entry of this name, including a dangling link; never throws. An entry
/// that cannot be examined counts as present, so that reading it gives the reason.
[[nodiscard]] bool stands_there(const std::filesystem::path& file);

/// Compares every file that SHA256SUMS names with its digest.
/// @param differences  Receives a line when the list itself is damaged.
/// @return kFile when an existing file cannot be read.
[[nodiscard]] core::Result<ListedFiles> check_listed_files(const std::filesystem::path& directory,
                                                           std::vector<std::string>& differences);

/// Checks the signature of SHA256SUMS with a public key, and that the list and `files` agree:
/// existing files are listed, and listed files exist.
/// @param differences  Receives a line for each check that fails.
/// @return kBadOption for a key of another kind, kFile for a file that cannot be read.
[[nodiscard]] core::Result<void> check_signature(const std::filesystem::path& directory,
                                                 const std::string& public_key_pem,
                                                 const ListedFiles& listed,
                                                 const std::vector<std::string>& files,
                                                 std::vector<std::string>& differences);

// Files of a run directory that reports read beside the journal. Whoever can write new digests can
// change them and SHA256SUMS alike, so that digests alone do not show it.

/// Compares trials.bin with the draws that were just made. Draws that another build or another kind
/// of processor made cannot be compared, and are not taken by this program either: a note.
/// @param head   What this program writes before the draws.
/// @param drawn  Empty: the run has no intervals.
/// @return kFile when the file cannot be read.
[[nodiscard]] core::Result<void> compare_trials(const std::filesystem::path& directory,
                                                std::string_view head, std::string_view drawn,
                                                std::vector<std::string>& differences,
                                                std::vector<std::string>& notes);

/// Why earlier results cannot be those that the archive held when the run began: one of another
/// part, of a later run or of the run itself. Nothing where they can be.
[[nodiscard]] std::optional<std::string> fault_of_earlier(const EarlierResults& earlier,
                                                          const record::RunRecord& record);

}  // namespace rondure::reports
