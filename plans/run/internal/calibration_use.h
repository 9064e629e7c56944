#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "fixture/calibration.h"
#include "plans/schema/findings.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The calibration that a run uses, with its file byte for byte.
struct UsedCalibration {
  fixture::Calibration calibration;
  std::string text;
};

/// Reads `fixture.calibration` and checks that this plan may use it.
/// @param run_utc  Start of the run; empty: age and expiry are not looked at.
/// @return Nothing without the key; kFile, and the errors of fixture::parse_calibration() and
///         fixture::check_calibration(), with the pointer of the key.
[[nodiscard]] core::Result<std::optional<UsedCalibration>> used_calibration(
    const Plan& plan, std::string_view run_utc);

/// What the journal keeps of the fixture, for the whole run: its nominal axes, its travel and,
/// where there is one, the calibration itself ("fixture/calibration") and what the plan asks of it.
/// Nothing for a plan without a fixture.
[[nodiscard]] std::vector<record::Setting> fixture_settings(
    const Plan& plan, const std::optional<UsedCalibration>& calibration);

/// The key `fixture.calibration` of a plan, without its age.
void check_calibration_use(const Plan& plan, Findings& findings);

}  // namespace rondure::plans
