#pragma once

#include "cmm/error_model.h"
#include "cmm/simulated/part_surface.h"
#include "plans/plan.h"

namespace rondure::plans {

/// The hidden errors of the simulated machine and probe: values given in the plan, and those of the
/// class in `errors` for the others.
[[nodiscard]] cmm::MachineErrors machine_errors(const SimulationPlan& simulation);

/// The scatter of the points of a simulated scan.
[[nodiscard]] cmm::ScanScatter scan_scatter(const SimulatedMachinePlan& machine);

/// Expansion of, and dust on, the simulated part.
[[nodiscard]] cmm::PartErrors part_errors(const SimulatedPartPlan& part);

/// The hidden form of the simulated part for one feature, marks included.
[[nodiscard]] cmm::PartSurface simulated_surface(const SimulationPlan& simulation,
                                                 const FeaturePlan& feature);

}  // namespace rondure::plans
