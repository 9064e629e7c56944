#include "plans/run/internal/run_head.h"

#include <utility>

#include "core/units.h"
#include "core/version.h"
#include "fit/poses/walk.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/path/sampling.h"
#include "plans/schema/internal/setting_list.h"
#include "record/sha256.h"
#include "record/tasks/characteristic.h"
#include "record/tasks/run.h"
#include "record/tasks/surface.h"

namespace rondure::plans {
namespace {

void append(std::vector<record::Setting> more, std::vector<record::Setting>& out) {
  for (record::Setting& setting : more) out.push_back(std::move(setting));
}

/// How the evaluation brings a surface to 20 degC: points of a file by the declared temperature,
/// where there is one; their scales were those of another machine.
record::ExpansionSettings expansion_of(const Plan& plan, const FeaturePlan& feature) {
  const auto environment = plan.environment.value_or(EnvironmentPlan());
  record::ExpansionSettings out;
  if (is_touched(feature) || environment.assumed_degC) {
    out.part_expansion_per_K = plan.part.expansion_per_K;
  }
  if (out.part_expansion_per_K) {
    out.part_expansion_uncertainty_per_K = plan.part.expansion_uncertainty_per_K;
  }
  if (is_touched(feature)) out.scale_expansion_per_K = plan.machine->scale_expansion_per_K;
  if (out.scale_expansion_per_K) {
    out.scale_expansion_uncertainty_per_K = plan.machine->scale_expansion_uncertainty_per_K;
  }
  if (out.part_expansion_per_K || out.scale_expansion_per_K) {
    out.temperature_uncertainty_K = environment.temperature_uncertainty_K;
  }
  return out;
}

/// Converts a feature, without the digest and the layers of its points file, which is not read
/// here.
record::Feature feature_of(const Plan& whole, const FeaturePlan& plan) {
  record::Feature out;
  out.id = plan.id;
  const AnalysisKind* kind = analysis_kind(plan.type);
  out.shape = plan.type;
  if (kind != nullptr) {
    out.settings = kind->settings(plan);
    for (const SeriesFile& file : kind->files(plan)) {
      out.points_file += (out.points_file.empty() ? "" : ", ") + file.file;
    }
  }
  out.side = plan.side;
  out.nominal_diameter_mm = plan.nominal.diameter_mm;
  out.strategy = strategy_of(plan);
  if (is_touched(plan)) {
    out.layers = plan.sampling.layers;
    out.points_per_layer = plan.sampling.points_per_layer;
  } else if (plan.source && kind == nullptr) {
    out.points_file = plan.source->file;
    if (plan.source->points == record::PointsAre::kSurface) out.tip_radius_mm = 0.0;
    if (plan.source->tip_diameter_mm) out.tip_radius_mm = 0.5 * *plan.source->tip_diameter_mm;
  }
  if (out.strategy == record::Strategy::kVirtual) {
    out.search_steps_deg =
        fit::halved_steps(plan.pose_search.steps_deg, plan.pose_search.min_step_deg);
  }
  out.characteristics = characteristics_of(whole, plan);
  return out;
}

/// What the evaluation needs to know of a surface beside its points.
record::SurfaceSettings surface_settings(const Plan& plan, const FeaturePlan& feature) {
  record::SurfaceSettings out;
  out.letter = feature.letter;
  if (feature.source) out.clamping = clamping_of(plan, feature);
  out.faces = feature.nominal.faces;
  if (feature.type == record::Shape::kCone && feature.nominal.half_angle_deg != 0.0) {
    out.half_angle_deg = feature.nominal.half_angle_deg;
  }
  if (is_touched(feature)) {
    if (is_fixed(plan)) out.part_axis.assign(plan.part.axis.begin(), plan.part.axis.end());
    if (const auto targets = sampling_targets(feature)) {
      out.first_layer_mm = targets->front().z_mm;
    }
  }
  out.exclude = feature.exclude;
  return out;
}

/// Sampling and temperature correction of a touched feature, as needed by the evaluation.
std::vector<record::Setting> settings_of(const Plan& plan, const FeaturePlan& feature) {
  std::vector<record::Setting> out;
  if (analysis_kind(feature.type) == nullptr) {
    append(record::settings_of_task(surface_settings(plan, feature)), out);
    std::erase_if(out, [](const record::Setting& s) { return !s.number && s.text.empty(); });
  }
  if (feature.source) {
    record::SourceSettings source{
        {}, feature.source->valid_for_days, feature.source->plane, {}, {}};
    if (!feature.source->measured_utc.empty()) source.measured_utc = feature.source->measured_utc;
    append(record::settings_of_task(source, "source/"), out);
    if (analysis_kind(feature.type) == nullptr) {
      append(record::settings_of_task(expansion_of(plan, feature)), out);
    }
  }
  if (!is_touched(feature) || !plan.machine) return out;
  if (feature.sampling.method == record::SamplingMethod::kScan) {
    append(record::settings_of_task(record::SamplingSettings{feature.sampling.method}), out);
  }
  if (feature.pose_search.strategy == record::Strategy::kMerged) {
    append(record::settings_of_task(record::MergedPosesSettings{
               feature.pose_search.merge, static_cast<int>(feature.pose_search.poses.size()),
               plan.fixture->axis_point_mm, plan.fixture->axis_offset_mm}),
           out);
  }
  append(record::settings_of_task(expansion_of(plan, feature)), out);
  return out;
}

/// Settings of the whole run: the decision rule and the declared uncertainty, by their keys.
std::vector<record::Setting> settings_of(const Plan& plan) {
  std::vector<record::Setting> out = record::settings_of_task(plan.decision_rule, "decision_rule/");
  if (plan.probe && plan.probe->qualification.on_column()) {
    const QualificationPlan& q = plan.probe->qualification;
    append(record::settings_of_task(record::QualificationSettings{q.artefact, q.column_slope_deg},
                                    "qualification/"),
           out);
  }
  if (plan.environment) {
    const EnvironmentPlan& environment = *plan.environment;
    append(record::settings_of_task(record::EnvironmentSettings{"limits", environment.assumed_degC,
                                                                environment.max_drift_K},
                                    "environment/"),
           out);
  }
  if (plan.uncertainty) {
    append(record::settings_of_uncertainty(*plan.uncertainty, plan.part.expansion_per_K), out);
  }
  return out;
}

record::Header header_of(const Plan& plan, const RunOptions& options, std::uint64_t seed) {
  record::Header out;
  out.run_id = options.run_id;
  out.version = core::kVersion;
  out.processor = options.processor;
  out.started_utc = options.started_utc;
  out.plan_file = options.plan_file;
  out.plan_name = plan.plan.name;
  out.plan_revision = plan.plan.revision;
  out.plan_text = plan.text;
  out.plan_sha256 = record::sha256_hex(plan.text);
  out.part_id = plan.part.id;
  out.part_name = plan.part.name;
  out.drawing = plan.part.drawing;
  out.serial = options.serial;
  out.operator_name = options.operator_name;
  out.decision_rule = name_of(plan.decision_rule.rule);
  out.simulated = simulates_anything(plan);
  out.seed = out.simulated ? seed : 0;
  const EnvironmentPlan environment = plan.environment.value_or(EnvironmentPlan());
  out.temperature_min_degC = environment.min_degC;
  out.temperature_max_degC = environment.max_degC;
  return out;
}

/// What the probe is qualified on; empty for a plan without a probe.
record::Artefact artefact_of(const Plan& plan) {
  if (!plan.probe) return {};
  const QualificationPlan& q = plan.probe->qualification;
  return {0.5 * q.diameter_mm(), 0.5 * plan.probe->tip_diameter_mm,
          q.radius_tolerance_um * core::kMicrometre, q.form_limit_um * core::kMicrometre};
}

}  // namespace

record::Strategy strategy_of(const FeaturePlan& feature) {
  if (measures_by_touch(feature)) return record::Strategy::kStations;
  if (analysis_kind(feature.type) != nullptr) return record::Strategy::kSeries;
  if (feature.source) return record::Strategy::kPointsFile;
  return feature.pose_search.strategy;
}

record::RunRecord run_head(const Plan& plan, const RunOptions& options, std::uint64_t seed) {
  record::RunRecord out;
  out.header = header_of(plan, options, seed);
  out.artefact = artefact_of(plan);
  out.settings = settings_of(plan);
  for (const FeaturePlan& feature : plan.features) {
    record::Feature& asked = out.features.emplace_back(feature_of(plan, feature));
    for (record::Setting& setting : settings_of(plan, feature)) {
      asked.settings.push_back(std::move(setting));
    }
  }
  return out;
}

}  // namespace rondure::plans
