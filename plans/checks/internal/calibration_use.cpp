#include "plans/checks/internal/calibration_use.h"

#include <algorithm>

#include "core/units.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/path/internal/nominal_geometry.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::plans {
namespace {

constexpr const char* kCalibrationPointer = "/fixture/calibration";
constexpr const char* kCalibrationFilePointer = "/fixture/calibration/file";

fixture::CalibrationDemand demand_of(const Plan& whole, std::string_view run_utc) {
  const FixturePlan& plan = *whole.fixture;
  const fixture::FixtureLimits limits = limits_of(plan);
  fixture::CalibrationDemand out;
  out.fixture_id = plan.id;
  out.run_utc = run_utc;
  out.max_age_days = plan.calibration->max_age_days;
  if (const auto& limit = plan.calibration->max_residual_um) {
    out.max_residual_mm = *limit * core::kMicrometre;
  }
  const EnvironmentPlan environment = whole.environment.value_or(EnvironmentPlan());
  out.min_degC = environment.min_degC;
  out.max_degC = environment.max_degC;
  out.assumed_degC = environment.assumed_degC;
  out.lowest = {limits.min_alpha_rad, limits.min_beta_rad};
  out.highest = {limits.max_alpha_rad, limits.max_beta_rad};
  out.axis_point_mm = vector3(plan.axis_point_mm);
  out.axis_offset_mm = vector3(plan.axis_offset_mm);
  return out;
}

}  // namespace

core::Result<std::optional<UsedCalibration>> used_calibration(const Plan& plan,
                                                              std::string_view run_utc) {
  if (!plan.fixture || !plan.fixture->calibration) return std::nullopt;
  const std::string& file = plan.fixture->calibration->file;
  auto text = read_data_file(plan.folder / file, file, record::kMostDocumentBytes);
  if (!text) return core::fail(text.error().at(kCalibrationFilePointer));
  auto calibration = fixture::parse_calibration(*text, file);
  if (!calibration) {
    // Codes of structure refer to plans; this is another file.
    const bool no_json = calibration.error().code == core::Code::kSyntax;
    return core::fail(no_json ? core::Code::kSyntax : core::Code::kCalibration,
                      calibration.error().where + ": " + calibration.error().what,
                      kCalibrationFilePointer);
  }
  if (auto usable = fixture::check_calibration(*calibration, demand_of(plan, run_utc)); !usable) {
    return core::fail(usable.error().at(kCalibrationPointer));
  }
  return UsedCalibration{*std::move(calibration), *std::move(text)};
}

std::vector<record::Setting> fixture_settings(const Plan& plan,
                                              const std::optional<UsedCalibration>& calibration,
                                              std::optional<double> resolution_rad) {
  if (!plan.fixture) return {};
  const FixturePlan& fixture = *plan.fixture;
  record::FixtureSettings out;
  out.id = fixture.id;
  out.axis_point_mm = fixture.axis_point_mm;
  out.axis_offset_mm = fixture.axis_offset_mm;
  out.min_alpha_deg = fixture.min_alpha_deg;
  out.max_alpha_deg = fixture.max_alpha_deg;
  out.min_beta_deg = fixture.min_beta_deg;
  out.max_beta_deg = fixture.max_beta_deg;
  if (resolution_rad &&
      std::any_of(plan.features.begin(), plan.features.end(), measures_by_touch)) {
    out.resolution_deg = *resolution_rad / core::kDegree;
    if (fixture.reached_pose) {
      out.setting_uncertainty_deg = fixture.reached_pose->setting_uncertainty_deg;
    }
  }
  if (calibration) {
    out.max_age_days = fixture.calibration->max_age_days;
    out.max_residual_um = fixture.calibration->max_residual_um;
    out.calibration = calibration->text;
  }
  return record::settings_of_task(std::move(out), "fixture/");
}

void check_calibration_use(const Plan& plan, Findings& findings) {
  if (!plan.fixture || !plan.fixture->calibration || !findings.sound("/fixture")) return;
  if (std::any_of(plan.features.begin(), plan.features.end(), measures_by_touch)) return;
  if (plan.fixture->id.empty()) {
    findings.meaning(
        core::Code::kMissingKey, "/fixture/id",
        "this key is missing: what the fixture is called; a calibration belongs to one "
        "fixture");
    return;
  }
  if (const auto used = used_calibration(plan, {}); !used) {
    findings.meaning(used.error().code, used.error().where, used.error().what);
  }
}

}  // namespace rondure::plans
