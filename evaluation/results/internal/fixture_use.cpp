#include "evaluation/results/internal/fixture_use.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "fit/rotary/errors.h"
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

void make_void(const core::Phrase& reason, FeatureResult& result) {
  for (CharacteristicResult& characteristic : result.characteristics) {
    overrule(characteristic, Verdict::kVoid);
    characteristic.reason = reason;
  }
}

/// The gate of the growth of the fixture from its calibration to its use; none where that is not
/// known. A cloud of one pose moves as a whole; where poses are combined by the kinematics, an axis
/// that moved by more than the calibration leaves makes that figure untrue.
std::optional<Gate> growth_gate(const FixtureUse& use, const FeatureResult& result) {
  if (!use.expansion_1_K || !use.temperature_degC || !result.temperatures) return std::nullopt;
  const double change_K = std::abs(result.temperatures->mean_degC - *use.temperature_degC);
  const double growth_mm = *use.expansion_1_K * use.axis_height_mm * change_K;
  const double limit_mm = fit::StationGateOptions().point_u_mm / 3.0;
  Gate out;
  out.code = "calibration-temperature";
  out.condition = core::phrase("shift of the axes since the calibration, by temperature");
  out.found = growth_mm / core::kMicrometre;
  out.limit = limit_mm / core::kMicrometre;
  out.unit = "um";
  if (growth_mm <= limit_mm) return out;
  const bool combined = result.merged && !result.merged->joint;
  const bool voids = combined && growth_mm > use.residual_max_mm;
  out.outcome = voids ? Gate::Outcome::kVoids : Gate::Outcome::kWarns;
  out.reason = core::phrase(
      "{:.2f} K from the temperature of the calibration of the fixture move its axes by {} um "
      "(limit {} um; the calibration claims {} um): calibrate at the temperature of use",
      change_K, core::um(growth_mm), core::um(limit_mm), core::um(use.residual_max_mm));
  return out;
}

}  // namespace

FixtureFacts fixture_facts(const record::RunRecord& record, int feature) {
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
  const bool of_file = said->calibration && !said->calibrated_by;
  const std::string* text = of_file ? &*said->calibration : nullptr;
  if (said->calibrated_by) {
    const auto by = std::ranges::find(record.features, *said->calibrated_by, &record::Feature::id);
    if (by != record.features.end() && by->shape == record::Shape::kRotaryAxes) {
      use.source = static_cast<int>(by - record.features.begin());
      if (feature <= use.source) return out;
      text = taken_calibration(record, use.source);
    }
    if (text == nullptr) {
      use.invalid = core::error_of(
          core::Code::kCalibration,
          core::phrase("the run has no calibration of the fixture by {}", *said->calibrated_by));
      out.use = std::move(use);
      return out;
    }
  }
  if (text == nullptr) return out;
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
  use.temperature_degC =
      calibration->temperature_degC ? calibration->temperature_degC : assumed_degC(record);
  use.expansion_1_K = calibration->expansion_1_K;
  use.axis_height_mm = std::abs(calibration->axis_point_mm.z());
  if (auto holds = fixture::check_calibration(*calibration, demand_of(record, *said)); !holds) {
    use.invalid = holds.error();
  }
  if (use.invalid && said->calibrated_by) {  // the run went on in the nominal fixture
    out.use = std::move(use);
    return out;
  }
  out.kinematics = fixture::compensated(out.kinematics, *calibration);
  out.use = std::move(use);
  out.calibration = *calibration;
  return out;
}

const std::string* taken_calibration(const record::RunRecord& record, int source) {
  for (const record::Decision& decision : record.decisions) {
    const bool taken = decision.message.code == core::MessageCode::kCalibrationTaken;
    if (taken && decision.feature == source) return &decision.message.text(0);
  }
  return nullptr;
}

void apply_calibration(const std::optional<FixtureUse>& use, FeatureResult& result) {
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile;
  if (!use || !touched) return;
  if (use->invalid) {
    make_void(use->invalid->said(), result);
    return;
  }
  auto growth = growth_gate(*use, result);
  if (!growth) return;
  if (growth->outcome == Gate::Outcome::kVoids) make_void(growth->reason, result);
  if (growth->outcome == Gate::Outcome::kWarns) {
    result.warnings.push_back({core::Code::kInconsistent, growth->reason.english(), {}});
  }
  result.gates.push_back(*std::move(growth));
}

}  // namespace rondure::evaluation
