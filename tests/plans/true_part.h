#pragma once

#include <span>
#include <vector>

#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// What the characteristics of a drawing are on the simulated part itself: its surfaces without
/// noise at the planned sections and circles, all the way round. Each value follows its definition
/// by a dense search that shares nothing with the evaluation. Characteristics with a filter, a
/// window, a portion, an equalised datum or statistics of other definition have none.
/// @param features  As recorded: with the resolved indications and the letters.
/// @return "run-out C_um" for the characteristic "run-out C"; a size in mm, "30h6 GN_mm"; empty for
///         a part that is one cylinder at a time.
/// Source: methods, drawing sections 2 to 5 and 10.
[[nodiscard]] std::vector<record::TruthValue> truths_of(const Plan& plan,
                                                        std::span<const record::Feature> features);

}  // namespace rondure::plans
