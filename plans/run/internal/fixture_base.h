#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/registration.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// Steps that touch the references of `fixture.datum`: its spheres one after the other, or its seat
/// (layer 0) and then its holes (layer i + 1: hole i), each from park height down, around, and up
/// again. Approach and search are longer by the largest offset of the base. `row.layer` is the
/// layer. Empty without `fixture.datum`.
/// @return kUnreachable where a known obstacle is in the way.
[[nodiscard]] core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan);

/// The base frame of the fixture from these touches. Of spheres: a sphere is fitted to each, and
/// the nominal centres are registered with the fitted ones. Of seat and holes: the least-squares
/// plane through the contact points of the seat gives the normal and the height; the centre of a
/// hole is that of the least-squares circle of its touches, seen along the normal;
/// fit::plane_registration() fits the nominal centres to them.
/// @param tips_W_mm      One list of tip centres per layer of datum_steps().
/// @param tip_radius_mm  Effective radius of the tip; of holes only.
/// @return  Motion: X_WF. kCalibration when a sphere has more form than probing allows
///          (probe.qualification.form_limit_um), or seat or hole more than residual_limit_um; when
///          the centres fit worse than that; when a diameter is more than 0.2 mm from its nominal
///          one (another hole). kLocation when one of them is farther off than uncertainty_mm.
[[nodiscard]] core::Result<fit::Registration> fixture_base(
    const Plan& plan, std::span<const std::vector<Eigen::Vector3d>> tips_W_mm,
    double tip_radius_mm);

/// A base that was found, for the journal: shift [mm], turn as a rotation vector [deg], residual.
[[nodiscard]] core::Message base_message(const fit::Registration& base);

/// Touches the references of `fixture.datum`, journals touches and result, and sets the base of the
/// cell; does nothing without that key. The kinematics are then on the located base.
/// @param tip_radius_mm  Effective radius of the tip.
[[nodiscard]] core::Result<void> find_fixture_base(RunContext& context, double tip_radius_mm);

}  // namespace rondure::plans
