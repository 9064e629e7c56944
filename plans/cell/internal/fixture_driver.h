#pragma once

#include <memory>

#include "core/result.h"
#include "fixture/fixture.h"
#include "plans/cell/cell.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Whether the fixture of a plan stands here and is driven by this program, or by a person whom it
/// asks: neither simulated nor part of a machine behind I++ DME. In front of a simulated machine
/// the person is simulated, too.
[[nodiscard]] bool drives_fixture(const Plan& plan);

/// Opens the driver of such a fixture; nothing turns.
/// @return  kMachine when it is not plugged in, is busy, may not be opened, or does not answer;
///          kBadOption when a person is to set it and `options` name nobody to ask.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_fixture(
    const FixturePlan& plan, const CellOptions& options);

}  // namespace rondure::plans
