#pragma once

#include "cmm/error_model.h"
#include "cmm/simulated/part_surface.h"
#include "plans/plan.h"

namespace rondure::plans {

/// The hidden errors of the simulated machine and probe: what the plan gives, else what its
/// `errors` says.
[[nodiscard]] cmm::MachineErrors machine_errors(const SimulationPlan& simulation);

/// How the points of a simulated scan lie.
[[nodiscard]] cmm::ScanScatter scan_scatter(const SimulatedMachinePlan& machine);

/// Expansion of, and dust on, the simulated part.
[[nodiscard]] cmm::PartErrors part_errors(const SimulatedPartPlan& part);

/// The hidden form of the simulated part for one feature, marks included.
[[nodiscard]] cmm::PartSurface simulated_surface(const SimulationPlan& simulation,
                                                 const FeaturePlan& feature);

}  // namespace rondure::plans
