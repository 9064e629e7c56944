#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "plans/plan.h"
#include "plans/schema/findings.h"

// Problems that no single key shows: contradicting keys, layers off the part, unreadable files.
// Each check uses only values without a problem of structure.

namespace rondure::plans {

/// Runs all checks below, in this order.
void check_plan(const Plan& plan, Findings& findings);

/// Checks travel, resolution, temperature limits, and everything that touched features need.
void check_equipment(const Plan& plan, Findings& findings);

/// Checks seat and holes of `fixture.datum`.
/// @pre There are some.
void check_datum_holes(const Plan& plan, Findings& findings);

/// Checks the keys of the sphere or column that qualifies the probe, and that a column can vouch
/// for what is touched.
void check_qualification(const Plan& plan, Findings& findings);

/// Makes "fixed" the fixture of a plan that leaves it out and touches surfaces. With it the part
/// stands where `part` says, what holds it takes the place of the clamping ring, and start-pose is
/// the default of the pose search.
void stand_without_fixture(Plan& plan, const Findings& findings);

/// Checks the place of a part without a fixture, and that no key needs axes; with a fixture, that
/// the keys of such a part are not given.
void check_fixed_part(const Plan& plan, Findings& findings);

/// Checks ids, keys that have no effect, and check_drawing().
void check_feature(const Plan& plan, std::size_t index, Findings& findings);

/// Checks what the drawing asks of a feature: its characteristics, datums, letter and windows.
void check_drawing(const Plan& plan, std::size_t index, Findings& findings);

/// Checks the datums of a characteristic.
/// @param where  JSON pointer of the characteristic.
void check_datums(const Plan& plan, std::size_t index, const record::CharacteristicTask& asked,
                  const std::string& where, Findings& findings);

/// Gives datums, and the features that name them, the strategy "start-pose" where they say none:
/// what two poses saw is not related.
void measure_datums_in_one_pose(Plan& plan, const Findings& findings);

/// Checks that a plane with a run-out, or that is a datum, says to which side it faces.
void check_faces(const Plan& plan, std::size_t index, Findings& findings);

/// Checks the windows of a feature, and that they leave enough layers of a touched one.
void check_windows(const Plan& plan, std::size_t index, Findings& findings);

/// Checks that the sampling carries a characteristic: opposite points, generatrices, a dense
/// section. Of points of a file only the highest harmonic is checked.
/// @param resolved  With the defaults of feature and plan.
void check_sampling_of(const FeaturePlan& feature, const record::Characteristic& resolved,
                       const std::string& where, Findings& findings);

/// Index of the first earlier entry with the same id.
template <class Entries>
[[nodiscard]] std::optional<std::size_t> earlier_with_same_id(const Entries& entries,
                                                              std::size_t index) {
  for (std::size_t k = 0; k < index; ++k) {
    if (!entries[k].id.empty() && entries[k].id == entries[index].id) return k;
  }
  return std::nullopt;
}

/// Checks nominal, layers and points of a touched feature: on the part, outside the clamp,
/// reachable.
void check_sampling(const Plan& plan, std::size_t index, Findings& findings);

/// Checks start and steps of the pose search of a touched feature against the fixture.
void check_pose_search(const Plan& plan, std::size_t index, Findings& findings);

/// Checks the points file of a feature that has one: opens, reads and counts it.
void check_points_file(const Plan& plan, std::size_t index, Findings& findings);

/// Checks parameters and statements of the decision rule, and that the uncertainty provides its
/// inputs.
void check_uncertainty(const Plan& plan, Findings& findings);

/// Checks that each surface of the simulated part is a touched feature of the plan, with keys of
/// its type.
void check_simulated_part(const Plan& plan, Findings& findings);

/// Refuses touched cylinders of two diameters at one place of the part: a path to the one would
/// meet the other.
void check_overlaps(const Plan& plan, Findings& findings);

/// Whether a feature is touched by the machine: neither read from a file nor an analysis of series.
[[nodiscard]] bool is_touched(const Plan& plan, std::size_t index, const Findings& findings);

}  // namespace rondure::plans
