#pragma once

#include <cstddef>

#include "core/pose.h"
#include "core/result.h"
#include "plans/plan.h"

// Whether a fixture can be calibrated as far as its drive goes: known from resolution and readings
// before a ball is touched.

namespace rondure::plans {

/// Checks before the first touch that the axis that is not measured will stand close enough to its
/// zero: one count of the drive, or `setting_uncertainty_deg` of a fixture that is set by hand, is
/// within fit::station_gate_rad(). Passes for features of other types.
/// @param resolution_rad  Of the driver.
/// @return kMeaning with number, limit and remedy.
[[nodiscard]] core::Result<void> check_zero_is_held(const Plan& plan, std::size_t feature,
                                                    double resolution_rad);

/// Checks a pose of a calibration before its touches: an axis that was sent to 0 reads 0 within
/// that limit, and no reading is farther from its command than fit::drive_gate_rad(). Passes for
/// features of other types.
/// @return kMachine with number, limit and remedy; the run can be resumed and repeats the move.
[[nodiscard]] core::Result<void> check_station_reached(const Plan& plan, std::size_t feature,
                                                       const core::Pose& commanded,
                                                       const core::Pose& reached,
                                                       double resolution_rad);

}  // namespace rondure::plans
