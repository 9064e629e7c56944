#pragma once

#include <span>

#include "fit/rotary/axes.h"

// Checks of identify_rotary_axis() on its input, before and after solving. Each function returns
// the first error that it finds, with the codes of identify_rotary_axis().

namespace rondure::fit {

/// Checks axis, numbers, names and angles.
[[nodiscard]] core::Result<void> check_measurement(const RotaryMeasurement& measurement);

/// Checks that units agree and balls are not confused: no distance between two balls may change by
/// more than a tenth.
[[nodiscard]] core::Result<void> check_sizes(const RotaryMeasurement& measurement,
                                             std::span<const BallCentre> reference);

/// Checks that the body turned as stated: at most 0.1 rad of rotation remain at any station, and
/// neither the opposite sense nor degrees for radians leave ten times less. The error names the
/// stations with a wrong label if the others agree with each other, or the rotation that the other
/// hypotheses leave.
[[nodiscard]] core::Result<void> check_sense(const RotaryMeasurement& measurement,
                                             std::span<const BallCentre> reference);

/// Checks that distances between balls neither drift over the stations nor differ from the
/// reference by more than 4 standard uncertainties of a distance. Uses medians, so that a single
/// wrong ball counts as an outlier and not as drift.
[[nodiscard]] core::Result<void> check_distances(const RotaryMeasurement& measurement,
                                                 std::span<const BallCentre> reference);

/// Checks that no station, nor the reference pose, deviates about the axis from the line through
/// its neighbours by more than 1 mrad and five times the deviation of the others. The error states
/// the angle with which the station should have been labelled.
/// @return A warning for stations beyond 0.1 mrad.
[[nodiscard]] core::Result<std::vector<core::Error>> check_neighbours(
    std::span<const RotaryStation> stations, const RotaryAxis& axis, double reference_rad);

/// Checks that stations whole turns apart, with the same direction of approach, agree within 4
/// standard uncertainties.
/// @return Whether there were any.
[[nodiscard]] core::Result<bool> check_periodicity(std::span<const RotaryStation> stations);

}  // namespace rondure::fit
