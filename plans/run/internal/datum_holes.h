#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/registration.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// Steps that touch the seat of the fixture (layer 0) or one of its holes, dowels and bolt heads
/// (layer i + 1: hole i). A hole is touched from its axis, the highest height first.
[[nodiscard]] std::vector<TouchStep> layer_steps(const Plan& plan, std::size_t layer);

/// The base frame of the fixture from these touches. The least-squares plane through the contact
/// points of the seat gives the normal and the height; the centre of a hole is that of the
/// least-squares circle of its touches, seen along the normal; fit::plane_registration() fits the
/// nominal centres to them.
/// @param tips_W_mm      Tip centres of the seat, then one list per hole.
/// @param tip_radius_mm  Effective radius of the tip.
/// @return  Motion: X_WF. kCalibration when seat or hole have more form, or the centres fit worse,
///          than residual_limit_um, or a diameter is more than 0.2 mm from its nominal one (another
///          hole); kLocation when one of them is farther off than uncertainty_mm.
/// Source: methods, machine cell section 6.2. A plane from hole axes, which it allows as well, is
/// not offered: two heights 10 mm apart, each found to 1 um, give it to 140 urad, a seat of 180 mm
/// to some 10 urad, and axes say nothing about the height.
[[nodiscard]] core::Result<fit::Registration> base_from_holes(
    const Plan& plan, std::span<const std::vector<Eigen::Vector3d>> tips_W_mm,
    double tip_radius_mm);

}  // namespace rondure::plans
