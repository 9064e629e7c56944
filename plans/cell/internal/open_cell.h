#pragma once

#include <memory>

#include "cmm/machine.h"
#include "core/result.h"
#include "plans/cell/cell.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Checks that a machine has the abilities that the plan requires. kMachine, at the feature, when
/// it has to scan and cannot.
[[nodiscard]] core::Result<void> check_abilities(const Plan& plan,
                                                 const cmm::Capabilities& machine);

/// Opens the cell of a plan that has `machine`, `fixture` and `probe`, with the drivers named
/// there. Nothing moves. kMachine when a machine or a fixture cannot be reached, or lacks an
/// ability (check_abilities()).
[[nodiscard]] core::Result<std::unique_ptr<Cell>> open_cell(const Plan& plan,
                                                            const CellOptions& options);

}  // namespace rondure::plans
