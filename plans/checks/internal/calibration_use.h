#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "fixture/calibration.h"
#include "plans/plan.h"
#include "plans/schema/findings.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The calibration that a run uses, with the bytes of its file.
struct UsedCalibration {
  fixture::Calibration calibration;
  std::string text;
};

/// Reads the file of `fixture.calibration` and checks that this plan may use it.
/// @param run_utc  Start of the run; empty: age and expiry are not checked.
/// @return Nothing without a file; kFile, and the errors of fixture::parse_calibration() and
///         fixture::check_calibration(), with the pointer of the key.
[[nodiscard]] core::Result<std::optional<UsedCalibration>> used_calibration(
    const Plan& plan, std::string_view run_utc);

/// The calibration that a feature of the run found, for those after it.
/// @param text  As fixture-calibration.json would hold it.
/// @return  Errors of fixture::parse_calibration() and fixture::check_calibration().
[[nodiscard]] core::Result<fixture::Calibration> usable_calibration(const Plan& plan,
                                                                    std::string_view text,
                                                                    std::string_view run_utc);

/// The settings of the fixture in the journal, for the whole run: its nominal axes, its travel and,
/// if there is one, the calibration itself ("fixture/calibration") with the plan's requirements on
/// it. Empty for a plan without a fixture.
/// @param resolution_rad  Of the driver; kept for a run that calibrates the fixture.
[[nodiscard]] std::vector<record::Setting> fixture_settings(
    const Plan& plan, const std::optional<UsedCalibration>& calibration,
    std::optional<double> resolution_rad);

/// Checks the key `fixture.calibration` of a plan, except for the age.
void check_calibration_use(const Plan& plan, Findings& findings);

}  // namespace rondure::plans
