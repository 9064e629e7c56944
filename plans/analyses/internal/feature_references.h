#pragma once

#include <cstddef>

#include "plans/plan.h"
#include "plans/schema/findings.h"

namespace rondure::plans {

/// Checks the values that an analysis takes of other features: each of an earlier feature that
/// gives such a value. Features are done in the order of the plan.
void check_references(const Plan& plan, std::size_t index, Findings& findings);

}  // namespace rondure::plans
