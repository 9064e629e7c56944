#pragma once

#include <span>

#include "fit/rotary/axes.h"

// What identify_rotary_axis() asks of its input before and after solving. Each function gives the
// first thing that is wrong; codes as there.

namespace rondure::fit {

/// Axis, numbers, names, angles.
[[nodiscard]] core::Result<void> check_measurement(const RotaryMeasurement& measurement);

/// Sizes of one unit, balls not confused: no distance between two balls changes by more than a
/// tenth of it.
[[nodiscard]] core::Result<void> check_sizes(const RotaryMeasurement& measurement,
                                             std::span<const BallCentre> reference);

/// The body turned as stated: at most 0.1 rad of rotation are left at any station, and neither the
/// opposite sense nor degrees for radians leave ten times less. If not, names the stations whose
/// label is wrong where the others fit each other, or says what the other hypotheses leave.
[[nodiscard]] core::Result<void> check_sense(const RotaryMeasurement& measurement,
                                             std::span<const BallCentre> reference);

/// Distances between balls neither drift over the stations nor differ from the reference by more
/// than 4 standard uncertainties of a distance. Medians: a single wrong ball is an outlier and no
/// drift.
[[nodiscard]] core::Result<void> check_distances(const RotaryMeasurement& measurement,
                                                 std::span<const BallCentre> reference);

/// No station lies more than 1 mrad about the axis, and five times what the others do, off the line
/// through its neighbours; the reference pose is one of them. If one does, says which angle it
/// should have been labelled with.
/// @return A warning for stations beyond 0.1 mrad.
[[nodiscard]] core::Result<std::vector<core::Error>> check_neighbours(
    std::span<const RotaryStation> stations, const RotaryAxis& axis, double reference_rad);

/// Stations whole turns apart, approached alike, agree within 4 standard uncertainties.
/// @return Whether there were any.
[[nodiscard]] core::Result<bool> check_periodicity(std::span<const RotaryStation> stations);

}  // namespace rondure::fit
