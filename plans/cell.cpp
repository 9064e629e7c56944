#include "plans/cell.h"

#include "plans/ipp_cell.h"
#include "plans/plan_reach.h"
#include "plans/simulated_cell.h"

namespace rondure::plans {

Cell::Cell(const Plan& plan)
    : kinematics_(nominal_kinematics(*plan.fixture)), X_BP_(nominal_seat(*plan.fixture)) {}

core::Result<std::unique_ptr<Cell>> open_cell(const Plan& plan, const CellOptions& options) {
  if (plan.machine->driver == "ippdme") return IppCell::open(plan, options);
  return std::make_unique<SimulatedCell>(plan, options.seed, options.resumed);
}

// A real machine keeps no state that depends on the past.
core::Result<void> Cell::recall_scan(const cmm::ScanCircleCommand& /*command*/,
                                     const cmm::TouchReading& /*last*/) {
  return {};
}

}  // namespace rondure::plans
