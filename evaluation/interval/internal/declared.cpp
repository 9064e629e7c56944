#include "evaluation/interval/internal/declared.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "evaluation/results/internal/fixture_use.h"
#include "evaluation/results/measured_cloud.h"
#include "fixture/error_model.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {
namespace {

using core::kMicroradian;

constexpr double kPerMetre = 1e-3;  // 1/mm in 1/m

ProbeInfluences probe_influences(const record::ProbeInfluencesTask& said,
                                 const FeatureResult& result,
                                 const std::optional<fit::ProbeTip>& probe) {
  ProbeInfluences out;
  out.form_limit_mm = said.form_limit_um * core::kMicrometre;
  out.correlation_length_mm = said.correlation_length_mm;
  if (said.repeatability_um) {
    out.repeatability_mm = *said.repeatability_um * core::kMicrometre;
    out.degrees_of_freedom = said.degrees_of_freedom;
  } else if (out.form_limit_mm == 0.0) {  // a limit contains it
    out.repeatability_known = result.repeat_sigma_mm.has_value();
    out.repeatability_mm = result.repeat_sigma_mm.value_or(0.0);
    out.degrees_of_freedom = result.repeat_freedom;
  }
  out.tip_radius_mm = said.tip_radius_um ? *said.tip_radius_um * core::kMicrometre
                      : probe            ? probe->radius_sigma_mm
                                         : 0.0;
  out.reference_sphere_mm = said.reference_sphere_um.value_or(0.0) * core::kMicrometre;
  for (const record::LobeInfluenceTask& lobe : said.lobes) {
    if (lobe.amplitude_um == 0.0) continue;  // declares nothing
    out.lobes.push_back({lobe.order, lobe.amplitude_um * core::kMicrometre, 0.0});
  }
  return out;
}

/// The curve of an error term with the name that ISO 230-1 gives it: "EYX" is along y, of the x
/// axis; "EAX" is about x.
cmm::ErrorCurve& translation_of(cmm::GeometricErrors& terms, const std::string& name) {
  return terms.axes[static_cast<std::size_t>(name[2] - 'X')]
      .translation[static_cast<std::size_t>(name[1] - 'X')];
}
cmm::ErrorCurve& rotation_of(cmm::GeometricErrors& terms, const std::string& name) {
  return terms.axes[static_cast<std::size_t>(name[2] - 'X')]
      .rotation[static_cast<std::size_t>(name[1] - 'A')];
}

MachineInfluences machine_influences(const record::MachineInfluencesTask& said) {
  MachineInfluences out;
  for (const record::TranslationError& term : said.translations) {
    constexpr double kUnit = core::kMicrometre;
    translation_of(out.terms, term.error) = {term.linear_um_m * kUnit * kPerMetre,
                                             term.quadratic_um_m2 * kUnit * kPerMetre * kPerMetre,
                                             term.wave_um * kUnit, term.wave_period_mm, 0.0};
  }
  for (const record::RotationError& term : said.rotations) {
    rotation_of(out.terms, term.error) = {
        term.linear_urad_m * kMicroradian * kPerMetre,
        term.quadratic_urad_m2 * kMicroradian * kPerMetre * kPerMetre,
        term.wave_urad * kMicroradian, term.wave_period_mm, 0.0};
  }
  out.terms.squareness_xy_rad = said.squareness_xy_urad * kMicroradian;
  out.terms.squareness_xz_rad = said.squareness_xz_urad * kMicroradian;
  out.terms.squareness_yz_rad = said.squareness_yz_urad * kMicroradian;
  out.terms.tip_offset_mm = {said.tip_offset_x_mm, said.tip_offset_y_mm, said.tip_offset_z_mm};
  out.length_limit_mm = said.length_limit_um * core::kMicrometre;
  out.length_limit_slope = said.length_limit_um_m * core::kMicrometre * kPerMetre;
  return out;
}

/// What the environment says of the temperature counts also where no drift is declared: lengths are
/// corrected by it.
std::optional<ThermalInfluences> thermal_influences(
    const std::optional<record::ThermalInfluencesTask>& declared,
    const std::optional<double>& expansion_per_K, const FeatureResult& result) {
  const auto expansion = record::task_of<record::ExpansionSettings>(result.feature.settings)
                             .value_or(record::ExpansionSettings());
  if (!declared && !(expansion.part_expansion_per_K && expansion.temperature_uncertainty_K)) {
    return std::nullopt;
  }
  const auto said = declared.value_or(record::ThermalInfluencesTask());
  ThermalInfluences out;
  out.drifts_declared = declared.has_value();
  out.temperature_K = expansion.temperature_uncertainty_K.value_or(0.0);
  // Points of a file bring no temperatures to correct by, but drift as the part does.
  out.expansion_1_K = expansion.part_expansion_per_K.value_or(expansion_per_K.value_or(0.0));
  out.expansion_uncertainty_1_K = expansion.part_expansion_uncertainty_per_K.value_or(0.0);
  if (result.temperatures) out.from_reference_K = result.temperatures->mean_degC - 20.0;
  out.drift_K = said.drift_K;
  out.machine_drift_mm = {said.machine_drift_x_um * core::kMicrometre,
                          said.machine_drift_y_um * core::kMicrometre,
                          said.machine_drift_z_um * core::kMicrometre};
  return out;
}

FixtureInfluences influences_of(const record::FixtureInfluencesTask& said) {
  FixtureInfluences out;
  out.angle_rad = said.angle_deg * core::kDegree;
  out.position_mm = said.position_um * core::kMicrometre;
  out.creep_rad = said.creep_deg * core::kDegree;
  return out;
}

/// What the calibration of the fixture leaves in the poses of a feature; none where the run used
/// none that holds, or nothing was touched.
std::optional<CalibrationInfluences> calibration_influences(const record::RunRecord& record,
                                                            const FeatureResult& result) {
  if (result.feature.strategy == record::Strategy::kPointsFile) return std::nullopt;
  const auto own = std::ranges::find(record.features, result.feature.id, &record::Feature::id);
  const FixtureFacts facts = fixture_facts(record, static_cast<int>(own - record.features.begin()));
  if (!facts.calibration || !facts.use || facts.use->invalid) return std::nullopt;
  const FixtureUse& use = *facts.use;
  CalibrationInfluences out;
  out.id = use.id;
  out.age_days = use.age_days;
  out.draws = Eigen::MatrixXd::Zero(6, 0);
  if (!result.merged) return out;
  const std::vector<core::Pose>& poses = result.merged->poses;
  const Eigen::Isometry3d& X_WF = facts.kinematics.X_WF;
  out.poses = static_cast<int>(poses.size());
  out.draws = fixture::calibration_draws(*facts.calibration, poses, X_WF);
  if (use.expansion_1_K && use.temperature_degC && result.temperatures) {
    out.change_K = result.temperatures->mean_degC - *use.temperature_degC;
    out.growth = fixture::growth_draws(*facts.calibration,
                                       *use.expansion_1_K * std::abs(out.change_K), poses, X_WF);
  }
  return out;
}

/// "declared in the plan: 2 UPR 1.5 um, 0 UPR of degree 1 0.5 um; only their ratios count".
core::Phrase source_text(const FormSpectrum& spectrum) {
  core::Phrase terms;
  for (const FormTerm& term : spectrum.terms) {
    const double amplitude_um = term.amplitude_mm / core::kMicrometre;
    const core::Phrase one = term.degree > 0
                                 ? core::phrase("{} UPR of degree {} {:g} um", term.undulations,
                                                term.degree, amplitude_um)
                                 : core::phrase("{} UPR {:g} um", term.undulations, amplitude_um);
    terms = terms.empty() ? one : core::phrase("{}, {}", terms, one);
  }
  return core::phrase(
      "declared in the plan: {}; {}", terms,
      spectrum.absolute ? core::phrase("as they are") : core::phrase("only their ratios count"));
}

FormSpectrum spectrum_of(const record::FormSpectrumTask& said) {
  FormSpectrum out;
  out.absolute = said.amplitudes == record::FormSpectrumTask::Amplitudes::kAbsolute;
  for (const record::FormTermTask& term : said.terms) {
    out.terms.push_back({term.undulations, term.degree, term.amplitude_um * core::kMicrometre});
  }
  out.source = source_text(out);
  return out;
}

UncertaintyOptions options_of(const record::UncertaintyTask& said) {
  UncertaintyOptions out;
  out.coverage = 0.01 * said.coverage_percent;
  out.least_trials = said.least_trials;
  out.most_trials = said.most_trials;
  out.tolerance_mm = said.tolerance_um * core::kMicrometre;
  out.budget_trials = said.budget_trials;
  out.expected_spots = said.expected_spots;
  out.seed = said.seed;
  return out;
}

}  // namespace

std::optional<FixtureInfluences> fixture_influences(const record::RunRecord& record) {
  const auto recorded = record::recorded_uncertainty(record.settings);
  if (!recorded || !*recorded || !(*recorded)->task.fixture) return std::nullopt;
  return influences_of(*(*recorded)->task.fixture);
}

UncertaintyOptions uncertainty_options(const record::RunRecord& record) {
  const auto recorded = record::recorded_uncertainty(record.settings);
  if (recorded && *recorded) return options_of((*recorded)->task);
  UncertaintyOptions out;
  out.seed = record.header.seed;
  return out;
}

std::optional<Declared> declared_for(const record::RunRecord& record, const FeatureResult& result,
                                     const std::optional<fit::ProbeTip>& probe) {
  const auto recorded = record::recorded_uncertainty(record.settings);
  if (!recorded || !*recorded) return std::nullopt;
  const record::UncertaintyTask& said = (*recorded)->task;
  Declared out;
  if (said.probe) out.influences.probe = probe_influences(*said.probe, result, probe);
  if (said.machine) out.influences.machine = machine_influences(*said.machine);
  out.influences.thermal = thermal_influences(said.thermal, (*recorded)->expansion_per_K, result);
  const bool of_file = result.feature.strategy == record::Strategy::kPointsFile;
  out.influences.no_fixture = stands_still(result.feature) || (of_file && !said.fixture);
  if (said.fixture && !out.influences.no_fixture) {
    out.influences.fixture = influences_of(*said.fixture);
    const auto merged = record::task_of<record::MergedPosesSettings>(result.feature.settings);
    if (result.merged && merged) {  // the axes cross there, as for the solution of the poses
      out.influences.fixture->pivot_mm = Eigen::Vector3d::Map(merged->axis_point_mm.data());
    }
  }
  out.influences.calibration = calibration_influences(record, result);
  if (probe && result.feature.strategy != record::Strategy::kPointsFile) {
    out.influences.probing_span_mm = probe->form_mm;
  }
  out.options = options_of(said);
  if (said.form_spectrum) out.spectrum = spectrum_of(*said.form_spectrum);
  return out;
}

}  // namespace rondure::evaluation
