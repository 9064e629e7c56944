#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/registration.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// What a layer of datum_steps() touches, for messages: "sphere 2 of the fixture".
[[nodiscard]] std::string datum_name(const DatumPlan& datum, std::size_t layer);

/// Steps that touch the reference spheres on the base of the fixture, one after the other: from
/// park height down to the pole, around, up again. Approach and search are longer by the largest
/// offset of the base. `row.layer` is the sphere. With holes: layer_steps() of all layers. Empty
/// without `fixture.datum`.
/// @return kUnreachable where a known obstacle is in the way.
[[nodiscard]] core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan);

/// The base frame of the fixture, from the touches of its spheres: fits each sphere, then registers
/// the nominal centres with the fitted ones. With holes: base_from_holes().
/// @param tips_W_mm      One list of tip centres per layer of datum_steps().
/// @param tip_radius_mm  Effective radius of the tip; of holes only.
/// @return  Motion: X_WF. kCalibration when a sphere has more form than probing allows
///          (probe.qualification.form_limit_um) or the centres fit worse than residual_limit_um;
///          kLocation when a sphere is farther off than uncertainty_mm.
[[nodiscard]] core::Result<fit::Registration> fixture_base(
    const Plan& plan, std::span<const std::vector<Eigen::Vector3d>> tips_W_mm,
    double tip_radius_mm);

/// A base that was found, for the journal: shift [mm], turn as a rotation vector [deg], residual.
[[nodiscard]] core::Message base_message(const fit::Registration& base);

/// Touches the spheres or holes of `fixture.datum`, journals touches and result, and sets the base
/// of the cell; does nothing without that key. The kinematics are then on the located base.
/// @param tip_radius_mm  Effective radius of the tip.
[[nodiscard]] core::Result<void> find_fixture_base(RunContext& context, double tip_radius_mm);

/// Measures a feature of the type "rotary_axes": turns the fixture through rotary_visits() and
/// touches the balls in each pose. Everything is journalled before the next step. Touches of ball i
/// have layer i. After the last touch the hidden truth of a simulated fixture is stored as curves.
/// Evaluation: evaluation/rotary/result.h.
[[nodiscard]] core::Result<void> calibrate_fixture(RunContext& context, int feature_index);

/// Steps that touch one ball in a pose, from park height and up again; see sphere_steps().
/// @param X_WB  Body frame in that pose.
[[nodiscard]] core::Result<std::vector<TouchStep>> ball_steps(const Plan& plan, std::size_t feature,
                                                              const Eigen::Isometry3d& X_WB,
                                                              std::size_t ball);

/// Number of touches of the calibration.
[[nodiscard]] std::size_t calibration_touches(const Plan& plan, std::size_t feature);

}  // namespace rondure::plans
