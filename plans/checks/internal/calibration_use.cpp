#include "plans/checks/internal/calibration_use.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/checks/internal/bodies.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/schema/json_text.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::plans {
namespace {

constexpr const char* kCalibrationPointer = "/fixture/calibration";
constexpr const char* kCalibrationFilePointer = "/fixture/calibration/file";
constexpr const char* kCalibrationFeaturePointer = "/fixture/calibration/feature";

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

/// Checks an end of travel against the stations of the feature that calibrates it.
void check_covered(std::string_view axis, const std::vector<double>& stations_deg, double min_deg,
                   double max_deg, Findings& findings) {
  if (stations_deg.empty()) return;
  const auto [low, high] = std::minmax_element(stations_deg.begin(), stations_deg.end());
  if (min_deg >= std::min(0.0, *low) && max_deg <= std::max(0.0, *high)) return;
  findings.meaning(core::Code::kPoseRange, kCalibrationFeaturePointer,
                   fmt::format("{0} may turn over {1}..{2} deg, its stations cover {3}..{4} deg; "
                               "narrow min_{0}_deg and max_{0}_deg, or add stations",
                               axis, plain(min_deg), plain(max_deg), plain(std::min(0.0, *low)),
                               plain(std::max(0.0, *high))));
}

/// Checks that a feature of this plan can calibrate the fixture for those after it.
void check_joined(const Plan& plan, Findings& findings) {
  const std::string named = in_quotes(plan.fixture->calibration->feature);
  const auto refuse = [&](std::string what) {
    findings.meaning(core::Code::kMeaning, kCalibrationFeaturePointer, std::move(what));
  };
  const std::size_t source = calibrating_feature(plan);
  if (source == plan.features.size()) {
    return refuse(fmt::format(
        "no feature has the id {}; name the feature of type rotary_axes that calibrates", named));
  }
  const FeaturePlan& feature = plan.features[source];
  if (!measures_by_touch(feature)) {
    return refuse(
        fmt::format("feature {} is a {}; a calibration is that of a feature of type "
                    "rotary_axes, and no feature takes one of itself",
                    named, name_of(feature.type)));
  }
  const auto after = plan.features.begin() + static_cast<std::ptrdiff_t>(source) + 1;
  if (std::none_of(after, plan.features.end(),
                   [](const FeaturePlan& f) { return is_touched(f); })) {
    return refuse(
        fmt::format("feature {} comes after all that is touched, and features are done "
                    "in the order of the plan; move it before those that take its "
                    "calibration",
                    named));
  }
  for (const FeaturePlan& other : plan.features) {
    if (&other == &feature || !measures_by_touch(other)) continue;
    return refuse(
        fmt::format("feature {} calibrates the fixture, too; a plan that inspects in it "
                    "has one such feature",
                    in_quotes(other.id)));
  }
  if (!feature.rotary_axes) return;
  check_covered("alpha", feature.rotary_axes->alpha_stations_deg, plan.fixture->min_alpha_deg,
                plan.fixture->max_alpha_deg, findings);
  check_covered("beta", feature.rotary_axes->beta_stations_deg, plan.fixture->min_beta_deg,
                plan.fixture->max_beta_deg, findings);
}

}  // namespace

core::Result<std::optional<UsedCalibration>> used_calibration(const Plan& plan,
                                                              std::string_view run_utc) {
  if (!plan.fixture || !plan.fixture->calibration) return std::nullopt;
  if (!plan.fixture->calibration->feature.empty()) return std::nullopt;  // not found yet
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
  if (const std::string files = body_files(plan); !files.empty()) out.bodies = files;
  if (fixture.calibration) {
    out.max_age_days = fixture.calibration->max_age_days;
    out.max_residual_um = fixture.calibration->max_residual_um;
    if (calibration) out.calibration = calibration->text;
    if (!calibration) out.calibrated_by = fixture.calibration->feature;
  }
  return record::settings_of_task(std::move(out), "fixture/");
}

core::Result<fixture::Calibration> usable_calibration(const Plan& plan, std::string_view text,
                                                      std::string_view run_utc) {
  TRY(auto calibration, fixture::parse_calibration(text, "the calibration of the fixture"));
  TRY_DO(fixture::check_calibration(calibration, demand_of(plan, run_utc)));
  return calibration;
}

void check_calibration_use(const Plan& plan, Findings& findings) {
  if (!plan.fixture || !plan.fixture->calibration || !findings.sound("/fixture")) return;
  const CalibrationPlan& said = *plan.fixture->calibration;
  if (said.file.empty() == said.feature.empty()) {
    const bool both = !said.file.empty();
    findings.meaning(
        both ? core::Code::kMeaning : core::Code::kMissingKey, kCalibrationFilePointer,
        both ? "file and feature are both given; keep the one whose calibration the run takes"
             : "this key is missing: name the file of the calibration, or with \"feature\" the "
               "feature of this plan that calibrates the fixture");
    return;
  }
  if (!said.feature.empty()) return check_joined(plan, findings);
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
