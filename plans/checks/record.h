#pragma once

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::plans {

/// Whether a record holds what its evaluation asks for, as a run leaves it: settings that the table
/// of the plan knows, each within its limits; the series and columns of every analysis, and no
/// other; touches of known poses, in whole numbers that fit the feature, with unit directions.
/// Readers ask before they evaluate: digests may fit all the same, where somebody made them again,
/// and another program's journal may say anything. Of another version's run, settings that this one
/// does not know are passed over.
/// @return kJournal with the first that does not hold, and where it stands.
[[nodiscard]] core::Result<void> check_record(const record::RunRecord& record);

}  // namespace rondure::plans
