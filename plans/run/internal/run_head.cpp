#include "plans/run/internal/run_head.h"

#include <string>
#include <utility>

#include "core/units.h"
#include "core/version.h"
#include "fit/poses/walk.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/schema/internal/uncertainty_table.h"
#include "record/sha256.h"

namespace rondure::plans {
namespace {

record::Characteristic characteristic_of(const CharacteristicPlan& plan) {
  record::Characteristic out;
  out.id = plan.id;
  out.form = plan.form;
  out.reference = plan.reference.value_or(record::Reference::kMinimumZone);
  if (plan.tolerance_um) out.tolerance_mm = *plan.tolerance_um * core::kMicrometre;
  out.drawing_zone = plan.drawing_zone;
  for (const HarmonicLimitPlan& line : plan.harmonic_limits) {
    out.harmonic_limits.push_back({line.from, line.to, line.amplitude_um * core::kMicrometre});
  }
  return out;
}

/// Adds the settings with which the evaluation merges the clouds of several poses.
void add_merged_settings(const FixturePlan& fixture, const FeaturePlan& feature,
                         std::vector<record::Setting>& out) {
  out.push_back({"merge", std::nullopt, std::string(name_of(feature.pose_search.merge))});
  out.push_back({"merged_poses", static_cast<double>(feature.pose_search.poses.size()), ""});
  for (const double v : fixture.axis_point_mm) out.push_back({"axis_point_mm", v, ""});
  for (const double v : fixture.axis_offset_mm) out.push_back({"axis_offset_mm", v, ""});
}

/// Converts a feature, without the digest of its points file, which is not read here.
record::Feature feature_of(const FeaturePlan& plan) {
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
    if (plan.source->tip_diameter_mm) out.tip_radius_mm = 0.5 * *plan.source->tip_diameter_mm;
  }
  if (out.strategy == record::Strategy::kVirtual) {
    out.search_steps_deg =
        fit::halved_steps(plan.pose_search.steps_deg, plan.pose_search.min_step_deg);
  }
  for (const CharacteristicPlan& c : plan.characteristics)
    out.characteristics.push_back(characteristic_of(c));
  return out;
}

/// Sampling and temperature correction of a touched feature, as needed by the evaluation.
std::vector<record::Setting> settings_of(const Plan& plan, const FeaturePlan& feature) {
  std::vector<record::Setting> out;
  if (!is_touched(feature) || !plan.machine) return out;
  const auto add = [&](std::string_view name, double number) {
    out.push_back({std::string(name), number, ""});
  };
  if (feature.sampling.method == record::SamplingMethod::kScan) {
    out.push_back({"sampling_method", std::nullopt, std::string(name_of(feature.sampling.method))});
  }
  if (feature.pose_search.strategy == record::Strategy::kMerged)
    add_merged_settings(*plan.fixture, feature, out);
  if (plan.part.expansion_per_K) {
    add("part_expansion_per_K", *plan.part.expansion_per_K);
    add("part_expansion_uncertainty_per_K", plan.part.expansion_uncertainty_per_K);
  }
  if (plan.machine->scale_expansion_per_K) {
    add("scale_expansion_per_K", *plan.machine->scale_expansion_per_K);
    add("scale_expansion_uncertainty_per_K", plan.machine->scale_expansion_uncertainty_per_K);
  }
  if (plan.part.expansion_per_K || plan.machine->scale_expansion_per_K) {
    add("temperature_uncertainty_K",
        plan.environment.value_or(EnvironmentPlan()).temperature_uncertainty_K);
  }
  return out;
}

/// Settings of the whole run: the decision rule and the declared uncertainty, by their keys.
std::vector<record::Setting> settings_of(const Plan& plan) {
  std::vector<record::Setting> out = record::settings_of_task(plan.decision_rule, "decision_rule/");
  if (plan.environment) {
    out.push_back({"environment/declared", std::nullopt, "limits"});
    if (const auto& degC = plan.environment->assumed_degC) {
      out.push_back({"environment/assumed_degC", *degC, ""});
    }
  }
  if (!plan.uncertainty) return out;
  const UncertaintyPlan& uncertainty = *plan.uncertainty;
  auto declared = record::settings_of_task(uncertainty, "uncertainty/");
  for (record::Setting& setting : declared) out.push_back(std::move(setting));
  if (uncertainty.thermal && plan.part.expansion_per_K) {
    out.push_back({"uncertainty/thermal/expansion_per_K", *plan.part.expansion_per_K, ""});
  }
  // A group without keys counts as declared as well.
  const auto given = [&](const char* name, bool there) {
    if (there) out.push_back({"uncertainty/declared", std::nullopt, name});
  };
  given("probe", uncertainty.probe.has_value());
  given("machine", uncertainty.machine.has_value());
  given("thermal", uncertainty.thermal.has_value());
  given("fixture", uncertainty.fixture.has_value());
  given("form_spectrum", uncertainty.form_spectrum.has_value());
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
  out.decision_rule = plan.decision_rule.rule;
  out.simulated = simulates_anything(plan);
  out.seed = out.simulated ? seed : 0;
  const EnvironmentPlan environment = plan.environment.value_or(EnvironmentPlan());
  out.temperature_min_degC = environment.min_degC;
  out.temperature_max_degC = environment.max_degC;
  return out;
}

/// The reference sphere; empty for a plan without a probe.
record::Artefact artefact_of(const Plan& plan) {
  if (!plan.probe) return {};
  const QualificationPlan& q = plan.probe->qualification;
  return {0.5 * q.sphere_diameter_mm, 0.5 * plan.probe->tip_diameter_mm,
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
    record::Feature& asked = out.features.emplace_back(feature_of(feature));
    for (record::Setting& setting : settings_of(plan, feature)) {
      asked.settings.push_back(std::move(setting));
    }
  }
  return out;
}

}  // namespace rondure::plans
