#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The differences between two plans as JSON: one kMeaning per value, `where` its pointer, `what`
/// the old and the new value. Order of keys, spaces and spellings of the same number are ignored.
/// @pre Both texts are valid plans.
[[nodiscard]] std::vector<core::Error> plan_changes(std::string_view old_text,
                                                    std::string_view new_text);

/// All reasons why a run, interrupted or finished, is not a run of this plan and these options:
/// changes of the plan, another version, seed, or name on the command line. Empty if it is one.
[[nodiscard]] std::vector<core::Error> changes_since(const record::RunRecord& run, const Plan& plan,
                                                     const RunOptions& options);

/// The error for a points file of a feature whose digest has changed.
[[nodiscard]] core::Error points_changed(std::size_t feature_index, const record::Feature& feature,
                                         const std::string& sha256);

}  // namespace rondure::plans
