#pragma once

#include <memory>

#include "core/result.h"
#include "fixture/fixture.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Opens the two Thorlabs units of a plan over USB; nothing turns.
/// @param plan  Has `thorlabs`.
/// @return  kMachine, at the key, when a unit is not plugged in, busy, not allowed, or another one.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_thorlabs(
    const FixturePlan& plan);

}  // namespace rondure::plans
