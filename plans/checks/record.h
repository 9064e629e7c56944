#pragma once

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::plans {

/// Checks that a record holds what its evaluation needs, as a run leaves it: settings that the
/// table of the plan knows, each within its limits; the series and columns of every analysis, and
/// no others; touches of known poses, in whole numbers that fit the feature, with unit directions.
/// Call it before an evaluation: digests may match even so, if somebody has recomputed them, and
/// another program's journal may contain anything. In a run of another version, settings unknown to
/// this version are ignored.
/// @return kJournal with the first violation and its place.
[[nodiscard]] core::Result<void> check_record(const record::RunRecord& record);

}  // namespace rondure::plans
