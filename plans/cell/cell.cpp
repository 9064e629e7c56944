#include "plans/cell/cell.h"

#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {

Cell::Cell(const Plan& plan)
    : kinematics_(nominal_kinematics(*plan.fixture)), X_BP_(nominal_seat(*plan.fixture)) {}

}  // namespace rondure::plans
