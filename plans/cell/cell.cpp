#include "plans/cell/cell.h"

#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {

Cell::Cell(const Plan& plan)
    : kinematics_(nominal_kinematics(*plan.fixture)), X_BP_(nominal_seat(*plan.fixture)) {}

// A real machine keeps no state that depends on the past.
core::Result<void> Cell::replay_scan(const cmm::ScanCircleCommand& /*command*/,
                                     const cmm::TouchReading& /*last*/) {
  return {};
}

}  // namespace rondure::plans
