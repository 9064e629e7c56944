#pragma once

#include "core/result.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// Checks that a record has what its evaluation needs. Its head, what was asked of the part, must
/// be that of the plan whose text the journal holds; series and columns those of every analysis,
/// and no others; touches those of known poses, in whole numbers that fit the feature, with unit
/// directions. Call it before an evaluation: digests also match if somebody has recomputed them,
/// and another program's journal may contain anything. In a run of another version of the program,
/// settings that only one of both knows are passed over.
/// @return kJournal with the first violation and its place; for a plan that this version cannot
///         read, its first fault.
[[nodiscard]] core::Result<void> check_record(const record::ReadJournal& read);

}  // namespace rondure::plans
