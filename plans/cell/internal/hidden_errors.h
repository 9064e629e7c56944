#pragma once

#include <vector>

#include "cmm/error_model.h"
#include "cmm/simulated/part.h"
#include "plans/plan.h"

namespace rondure::plans {

/// The hidden errors of the simulated machine and probe: values given in the plan, and those of the
/// class in `errors` for the others.
[[nodiscard]] cmm::MachineErrors machine_errors(const SimulationPlan& simulation);

/// The scatter of the points of a simulated scan.
[[nodiscard]] cmm::ScanScatter scan_scatter(const SimulatedMachinePlan& machine);

/// Expansion of, and dust on, the simulated part.
[[nodiscard]] cmm::PartErrors part_errors(const SimulatedPartPlan& part);

/// The hidden surface of a cylinder, circle or cone, marks included, in its own frame.
[[nodiscard]] cmm::PartSurface simulated_surface(const SimulationPlan& simulation,
                                                 const FeaturePlan& feature);

/// Whether the simulated part has all its surfaces at once: where the plan gives them places of
/// their own, or where one of them is a plane, a cone or a sphere. Else the part is the surface of
/// the feature that is being measured.
[[nodiscard]] bool has_whole_part(const Plan& plan);

/// A touched surface of the simulated part, part frame as in the plan.
[[nodiscard]] cmm::SimulatedPart::Placed placed_surface(const SimulationPlan& simulation,
                                                        const FeaturePlan& feature);

/// The simulated part while a feature is measured: all touched outside surfaces, or the block with
/// the bore that is measured. Where a face and the flat end of a shaft lie in one plane, the face
/// takes the place of the flat.
[[nodiscard]] cmm::SimulatedPart simulated_part(const std::vector<FeaturePlan>& features,
                                                const SimulationPlan& simulation,
                                                const FeaturePlan& mounted);

}  // namespace rondure::plans
