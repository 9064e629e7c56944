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

}  // namespace rondure::plans
