#pragma once

#include <memory>

#include "core/result.h"
#include "fixture/fixture.h"
#include "plans/cell/cell.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Whether this program, or a person on its request, drives the fixture of a plan, or there is none
/// ("fixed"): neither simulated nor part of an I++ DME machine. With a simulated machine the person
/// is simulated, too.
[[nodiscard]] bool drives_fixture(const Plan& plan);

/// Opens the driver of such a fixture; nothing turns.
/// @return  kMachine when the fixture is not plugged in, is busy, may not be opened, or does not
///          answer; kBadOption for a fixture set by hand without CellOptions::set_by_hand.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_fixture(
    const FixturePlan& plan, const CellOptions& options);

/// Opens the two Thorlabs units of a plan over USB; nothing turns.
/// @param plan  Must have `thorlabs`.
/// @return  kMachine, at the key, when a unit is not plugged in, busy, not permitted, or not the
///          one in the plan.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_thorlabs(
    const FixturePlan& plan);

}  // namespace rondure::plans
