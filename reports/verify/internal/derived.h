#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/run_record.h"
#include "reports/history/earlier_results.h"

namespace rondure::reports {

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
