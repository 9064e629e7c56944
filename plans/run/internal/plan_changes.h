#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "record/run_record.h"

namespace rondure::plans {

/// What differs between two plans as JSON: one kMeaning a value, `where` its pointer, `what` the
/// old and the new value. Order of keys, spaces and spellings of the same number do not count.
/// Both texts are plans that were read before.
[[nodiscard]] std::vector<core::Error> plan_changes(std::string_view old_text,
                                                    std::string_view new_text);

/// Everything for which a run, interrupted or finished, is not the run of this plan and these
/// options: changes of the plan, another version, seed, serial number or operator. Empty: it is.
[[nodiscard]] std::vector<core::Error> changes_since(const record::RunRecord& run, const Plan& plan,
                                                     const RunOptions& options);

/// The same for the points file of a feature, whose bytes have another digest now.
[[nodiscard]] core::Error points_changed(std::size_t feature_index, const record::Feature& feature,
                                         const std::string& sha256);

}  // namespace rondure::plans
