#pragma once

#include <memory>

#include "core/result.h"
#include "fixture/fixture.h"
#include "plans/cell.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Whether the fixture of a plan stands here and is driven by this program: neither simulated nor
/// part of a machine behind I++ DME.
[[nodiscard]] bool drives_fixture(const FixturePlan& fixture);

/// Opens the driver of such a fixture; nothing turns.
/// @return  kMachine when it is not plugged in, is busy, may not be opened, or does not answer.
[[nodiscard]] core::Result<std::unique_ptr<fixture::Fixture>> open_fixture(
    const FixturePlan& plan, const CellOptions& options);

}  // namespace rondure::plans
