#pragma once

#include <cstddef>

#include "plans/plan.h"
#include "plans/schema/findings.h"

// Problems that no single key shows: contradicting keys, layers off the part, unreadable files.
// Each check uses only values without a problem of structure.

namespace rondure::plans {

/// Runs all checks below, in this order.
void check_plan(const Plan& plan, Findings& findings);

/// Checks travel, resolution, temperature limits, and everything that touched features need.
void check_equipment(const Plan& plan, Findings& findings);

/// Checks ids, characteristics, and keys that have no effect.
void check_feature(const Plan& plan, std::size_t index, Findings& findings);

/// Checks nominal, layers and points of a touched feature: on the part, outside the clamp,
/// reachable.
void check_sampling(const Plan& plan, std::size_t index, Findings& findings);

/// Checks start and steps of the pose search of a touched feature against the fixture.
void check_pose_search(const Plan& plan, std::size_t index, Findings& findings);

/// Checks the points file of a feature that has one: opens, reads and counts it.
void check_points_file(const Plan& plan, std::size_t index, Findings& findings);

/// Checks parameters and statements of the decision rule, and that the uncertainty provides its
/// inputs.
void check_uncertainty(const Plan& plan, Findings& findings);

/// Checks that each surface of the simulated part is a touched feature of the plan, with keys of its
/// type.
void check_simulated_part(const Plan& plan, Findings& findings);

/// Whether a feature is touched by the machine: neither read from a file nor an analysis of series.
[[nodiscard]] bool is_touched(const Plan& plan, std::size_t index, const Findings& findings);

}  // namespace rondure::plans
