#pragma once

#include <span>
#include <vector>

#include "core/result.h"
#include "fit/geometry/registration.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// Steps that touch the reference spheres on the base of the fixture, one after the other: from
/// park height down to the pole, around, up again. Approach and search are longer by the largest
/// offset of the base. `row.layer` is the sphere. Empty without `fixture.datum`.
[[nodiscard]] core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan);

/// The base frame of the fixture, from the touches of its spheres: fits each sphere, then registers
/// the nominal centres with the fitted ones.
/// @param tips_W_mm  One list of tip centres per sphere, in the order of the plan.
/// @return  Motion: X_WF. kCalibration when a sphere has more form than probing allows
///          (probe.qualification.form_limit_um) or the centres fit worse than residual_limit_um;
///          kLocation when a sphere is farther off than uncertainty_mm.
[[nodiscard]] core::Result<fit::Registration> fixture_base(
    const Plan& plan, std::span<const std::vector<Eigen::Vector3d>> tips_W_mm);

/// A base that was found, for the journal: shift [mm], turn as a rotation vector [deg], residual.
[[nodiscard]] core::Message base_message(const fit::Registration& base);

/// Touches the spheres of `fixture.datum`, journals touches and result, and sets the base of the
/// cell; does nothing without that key. The kinematics are then on the located base.
[[nodiscard]] core::Result<void> find_fixture_base(RunContext& context);

}  // namespace rondure::plans
