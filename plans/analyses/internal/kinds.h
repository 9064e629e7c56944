#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "plans/analyses/analysis.h"
#include "plans/plan.h"
#include "plans/schema/findings.h"
#include "record/tasks/feature_reference.h"

namespace rondure::plans {

// Checks that plans of rotary axes share, of a fixture and of a head.

/// Checks that no station stands twice, and that there are enough beside 0.
/// @param zero  What the pose at 0 is called.
void check_axis_stations(const std::vector<double>& stations_deg, std::string_view zero,
                         const std::string& where, Findings& findings);

/// Checks that no ball before had this name.
void check_ball_id(const std::string& id, std::set<std::string>& seen, const std::string& where,
                   Findings& findings);

/// Simulated pins of a contour feature: traces of the controller, pins as the envelope of all wheel
/// positions with their non-following part, and main journals with that part alone. Without
/// `errors` and traces the main journals show exactly the non-following part of their pins.
/// @return The data, or the errors of wheel_path().
[[nodiscard]] core::Result<AnalysisData> simulate_contour(const Plan& plan, std::size_t index,
                                                          std::uint64_t seed, bool errors);

/// The words of the column "step", in the order of fit::HeadStep.
inline constexpr std::array<std::string_view, 4> kHeadSteps = {"reference", "C", "A",
                                                               "verification"};

/// Reads the files of poses of the features of type five_axis into their stations and verification.
/// A row that does not fit is named with its column.
void read_head_poses(Plan& plan, Findings& findings);

/// Checks that the poses of a head are those that a run began with.
/// @param recorded  The settings of the feature in its journal.
[[nodiscard]] core::Result<void> check_same_poses(const FeaturePlan& feature,
                                                  const std::vector<record::Setting>& recorded);

/// AnalysisKind::simulate of the type five_axis.
[[nodiscard]] core::Result<AnalysisData> simulate_five_axis(const Plan& plan, std::size_t index,
                                                            std::uint64_t seed, bool errors);

// Whether a fixture can be calibrated as far as its drive goes: known from resolution and readings
// before a ball is touched.

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

/// The wheel that a simulated feature names for its radius.
struct NamedWheel {
  double nominal_mm = 0.0;  ///< As its feature states it.
  /// Of the simulated body at speed, the circle that its edge sweeps; the nominal one where points
  /// of the wheel come from a file, as nothing else is known before they are evaluated.
  double true_mm = 0.0;
};

/// @pre The plan is checked: the feature is a wheel of mode envelope with a nominal radius.
[[nodiscard]] NamedWheel named_wheel(const Plan& plan, const record::FeatureReference& from);

}  // namespace rondure::plans
