#include "evaluation/internal/fixture_use.h"

#include <vector>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

Eigen::Vector3d vector_in(const record::RunRecord& record, const char* name) {
  const std::vector<double> v = record::numbers_in(record.settings, name);
  return v.size() < 3 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                      : Eigen::Vector3d(v[0], v[1], v[2]);
}

fixture::CalibrationDemand demand_of(const record::RunRecord& record) {
  const auto number = [&](const char* name) { return record::number_in(record.settings, name); };
  const auto angle = [&](const char* name) { return number(name).value_or(0.0) * core::kDegree; };
  fixture::CalibrationDemand out;
  out.fixture_id = record::word_in(record.settings, "fixture/id").value_or("");
  out.run_utc = record.header.started_utc;
  out.max_age_days = number("fixture/max_age_days");
  if (const auto limit = number("fixture/max_residual_um")) {
    out.max_residual_mm = *limit * core::kMicrometre;
  }
  if (record.header.temperature_min_degC < record.header.temperature_max_degC) {
    out.min_degC = record.header.temperature_min_degC;
    out.max_degC = record.header.temperature_max_degC;
  }
  out.assumed_degC = assumed_degC(record);
  out.lowest = {angle("fixture/min_alpha_deg"), angle("fixture/min_beta_deg")};
  out.highest = {angle("fixture/max_alpha_deg"), angle("fixture/max_beta_deg")};
  out.axis_point_mm = vector_in(record, "fixture/axis_point_mm");
  out.axis_offset_mm = vector_in(record, "fixture/axis_offset_mm");
  return out;
}

}  // namespace

FixtureFacts fixture_facts(const record::RunRecord& record) {
  FixtureFacts out;
  out.kinematics.axis_point_W_mm = vector_in(record, "fixture/axis_point_mm");
  out.kinematics.axis_offset_mm = vector_in(record, "fixture/axis_offset_mm");
  const auto text = record::word_in(record.settings, "fixture/calibration");
  if (!text) return out;
  FixtureUse use;
  const auto calibration = fixture::parse_calibration(*text, "fixture-calibration.json");
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
  if (auto holds = fixture::check_calibration(*calibration, demand_of(record)); !holds) {
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
