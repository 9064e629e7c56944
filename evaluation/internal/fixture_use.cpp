#include "evaluation/internal/fixture_use.h"

#include <utility>

#include "core/units.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

fixture::CalibrationDemand demand_of(const record::RunRecord& record,
                                     const record::FixtureSettings& said) {
  fixture::CalibrationDemand out;
  out.fixture_id = said.id;
  out.run_utc = record.header.started_utc;
  out.max_age_days = said.max_age_days;
  if (said.max_residual_um) out.max_residual_mm = *said.max_residual_um * core::kMicrometre;
  if (record.header.temperature_min_degC < record.header.temperature_max_degC) {
    out.min_degC = record.header.temperature_min_degC;
    out.max_degC = record.header.temperature_max_degC;
  }
  out.assumed_degC = assumed_degC(record);
  out.lowest = {said.min_alpha_deg * core::kDegree, said.min_beta_deg * core::kDegree};
  out.highest = {said.max_alpha_deg * core::kDegree, said.max_beta_deg * core::kDegree};
  out.axis_point_mm = Eigen::Vector3d::Map(said.axis_point_mm.data());
  out.axis_offset_mm = Eigen::Vector3d::Map(said.axis_offset_mm.data());
  return out;
}

}  // namespace

FixtureFacts fixture_facts(const record::RunRecord& record) {
  FixtureFacts out;
  const auto said = record::task_of<record::FixtureSettings>(record.settings, "fixture/");
  FixtureUse use;
  if (!said) {
    use.invalid = said.error();
    out.use = std::move(use);
    return out;
  }
  out.kinematics.axis_point_W_mm = Eigen::Vector3d::Map(said->axis_point_mm.data());
  out.kinematics.axis_offset_mm = Eigen::Vector3d::Map(said->axis_offset_mm.data());
  if (!said->calibration) return out;
  const auto calibration =
      fixture::parse_calibration(*said->calibration, "fixture-calibration.json");
  if (!calibration) {
    use.invalid = calibration.error();
    out.use = std::move(use);
    return out;
  }
  use.id = calibration->id;
  use.fixture_id = calibration->fixture_id;
  use.measured_utc = calibration->measured_utc;
  use.expires_utc = calibration->expires_utc;
  use.age_days = fixture::age_days(*calibration, record.header.started_utc);
  use.residual_rms_mm = calibration->verification.rms_mm;
  use.residual_max_mm = calibration->verification.max_mm;
  use.residual_tilt_rad = calibration->verification.max_tilt_rad;
  if (auto holds = fixture::check_calibration(*calibration, demand_of(record, *said)); !holds) {
    use.invalid = holds.error();
  }
  out.kinematics = fixture::compensated(out.kinematics, *calibration);
  out.use = std::move(use);
  return out;
}

void apply_calibration(const std::optional<FixtureUse>& use, FeatureResult& result) {
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile;
  if (!use || !use->invalid || !touched) return;
  for (CharacteristicResult& characteristic : result.characteristics) {
    characteristic.verdict = Verdict::kVoid;
    characteristic.reason = use->invalid->said();
    characteristic.outcome.reset();
    characteristic.risks.reset();
  }
}

}  // namespace rondure::evaluation
