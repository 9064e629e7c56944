#pragma once

#include "core/result.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// Checks that a record has the contents that its evaluation needs, in the form in which a run
/// writes them: settings known to the table of the plan, each within its limits; the series and
/// columns of every analysis, and no others; touches of known poses, in whole numbers that fit the
/// feature, with unit directions. Call it before an evaluation: digests also match if somebody has
/// recomputed them, and another program's journal may contain anything. In a run of another
/// version of the program, settings unknown to this version are ignored, and those that have a
/// default may be absent.
/// @return kJournal with the first violation and its place.
[[nodiscard]] core::Result<void> check_record(const record::ReadJournal& read);

}  // namespace rondure::plans
