#pragma once

#include <memory>

#include "core/result.h"
#include "fixture/fixture.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Opens the two Thorlabs units of a plan over USB; nothing turns.
/// @param plan  Must have `thorlabs`.
/// @return  kMachine, at the key, when a unit is not plugged in, busy, not permitted, or not the
///          one in the plan.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_thorlabs(
    const FixturePlan& plan);

}  // namespace rondure::plans
