#include "reports/data/writers.h"

#include <optional>

#include <fmt/format.h>

#include "evaluation/analysis.h"
#include "evaluation/results/feature_values.h"
#include "reports/data/internal/json_parts.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

Json axis_json(const fit::Axis& axis) {
  return {{"point_mm", vector_json(axis.point_mm)}, {"direction", vector_json(axis.direction)}};
}

Json plane_json(const fit::Plane& plane) {
  return {{"point_mm", vector_json(plane.point_mm)}, {"normal", vector_json(plane.normal)}};
}

Json header_json(const record::RunRecord& record) {
  const record::Header& h = record.header;
  const record::HeadSettings people = people_of(record);
  return {{"run_id", h.run_id},
          {"version", h.version},
          {"processor", h.processor},
          {"started_utc", h.started_utc},
          {"plan_file", h.plan_file},
          {"plan_name", h.plan_name},
          {"plan_revision", h.plan_revision},
          {"plan_sha256", h.plan_sha256},
          {"part_id", h.part_id},
          {"part_name", h.part_name},
          {"drawing", h.drawing},
          {"serial", h.serial},
          {"operator", h.operator_name},
          {"order", people.order.value_or("")},
          {"customer", people.customer.value_or("")},
          {"laboratory", people.laboratory.value_or("")},
          {"machine", h.machine},
          {"fixture", h.fixture},
          {"decision_rule", h.decision_rule},
          {"simulated", h.simulated},
          {"seed", h.seed},
          {"temperature_min_degC", h.temperature_min_degC},
          {"temperature_max_degC", h.temperature_max_degC},
          {"touches", record.touches.size()},
          {"ending", record.ending},
          {"failure", optional_json(record.failure)}};
}

Json fixture_json(const std::optional<evaluation::FixtureUse>& use) {
  if (!use) return nullptr;
  return {{"id", use->id},
          {"fixture", use->fixture_id},
          {"measured_utc", use->measured_utc},
          {"expires_utc", use->expires_utc},
          {"age_days", optional_json(use->age_days)},
          {"residual_rms_um", in_um(use->residual_rms_mm)},
          {"residual_max_um", in_um(use->residual_max_mm)},
          {"residual_tilt_urad", use->residual_tilt_rad * 1e6},
          {"invalid", optional_json(use->invalid)}};
}

Json probe_json(const std::optional<fit::ProbeTip>& probe) {
  if (!probe) return nullptr;
  Json out;
  if (probe->on_column()) {
    out = {{"column_point_mm", vector_json(probe->sphere_center_mm)},
           {"column_axis", vector_json(probe->column_axis)}};
  } else {
    out = {{"sphere_center_mm", vector_json(probe->sphere_center_mm)}};
  }
  out["tip_radius_mm"] = probe->radius_mm;
  out["tip_radius_sigma_um"] = in_um(probe->radius_sigma_mm);
  out["form_um"] = in_um(probe->form_mm);
  return out;
}

Json contacts_json(const std::vector<fit::Contact>& contacts,
                   const evaluation::FeatureResult& feature) {
  Json list = Json::array();
  for (const fit::Contact& contact : contacts) {
    if (contact.index >= feature.cloud.size()) continue;
    const evaluation::CloudPoint& point = feature.cloud[contact.index];
    list.push_back({{"layer", point.layer},
                    {"point", point.point},
                    {"row", contact.index},
                    {"multiplier", contact.multiplier}});
  }
  return list;
}

Json certificate_json(const fit::Certificate& certificate) {
  return {{"kind", fit::name_of(certificate.kind)},
          {"scope", certificate.scope},
          {"gap_um", in_um(certificate.gap_mm)},
          {"reason", certificate.reason}};
}

/// [least, greatest]; null where the reference is unique.
Json range_json(const std::optional<fit::DeviationRange>& range) {
  if (!range) return nullptr;
  return {in_um(range->low_mm), in_um(range->high_mm)};
}

Json zone_json(const evaluation::FeatureResult& feature) {
  if (feature.mz_plane) {
    const fit::MinZonePlane& mz = *feature.mz_plane;
    return {
        {"plane", plane_json(mz.outer)},
        {"deviation_um", in_um(mz.width_mm)},
        {"contacts",
         {{"outer", contacts_json(mz.top, feature)}, {"inner", contacts_json(mz.bottom, feature)}}},
        {"certificate", certificate_json(mz.certificate)}};
  }
  const auto zone = zone_of(feature);
  if (!zone) return nullptr;
  Json json;
  if (feature.mz_cylinder) {
    json["axis"] = axis_json(feature.mz_cylinder->axis);
  } else {
    json["center_mm"] = vector_json(feature.layers.front().mz->center_mm);
  }
  json["inner_radius_mm"] = zone->inner_radius_mm;
  json["outer_radius_mm"] = zone->outer_radius_mm;
  json["radii_of"] = zone->of_surface ? "surface" : "points";
  json["deviation_um"] = in_um(zone->deviation_mm);
  json["contacts"] = {{"outer", contacts_json(zone->outer, feature)},
                      {"inner", contacts_json(zone->inner, feature)}};
  json["certificate"] = certificate_json(zone->certificate);
  return json;
}

Json least_squares_json(const evaluation::FeatureResult& feature) {
  if (const auto& plane = feature.ls_plane) {
    return {{"plane", plane_json(plane->plane)},
            {"deviation_um", in_um(plane->deviation_mm)},
            {"rms_um", in_um(plane->rms_mm)}};
  }
  const auto ls = least_squares_of(feature);
  if (!ls) return nullptr;
  Json json;
  if (feature.ls_cylinder) {
    json["axis"] = axis_json(feature.ls_cylinder->axis);
  } else {
    json["center_mm"] = vector_json(feature.layers.front().ls->center_mm);
  }
  json["radius_mm"] = ls->radius_mm;
  json["deviation_um"] = in_um(ls->deviation_mm);
  json["rms_um"] = in_um(ls->rms_mm);
  return json;
}

/// "mc" or "mi" of a feature.
Json one_sided_json(const evaluation::FeatureResult& feature, record::Reference reference) {
  const auto found = one_sided_of(feature, reference);
  if (!found) return nullptr;
  const bool outside = reference == record::Reference::kMinimumCircumscribed;
  Json json;
  if (feature.mz_cylinder) {
    json["axis"] = axis_json((outside ? feature.mc_cylinder : feature.mi_cylinder)->axis);
  } else {
    const evaluation::LayerResult& section = feature.layers.front();
    json["center_mm"] = vector_json((outside ? section.mc : section.mi)->center_mm);
  }
  json["radius_mm"] = found->radius_mm;
  json["deviation_um"] = in_um(found->deviation_mm);
  json["deviation_range_um"] = range_json(found->range);
  json["contacts"] = {{outside ? "outer" : "inner", contacts_json(found->contacts, feature)}};
  json["certificate"] = certificate_json(found->certificate);
  return json;
}

Json one_sided_json(const core::Result<fit::OneSidedCircle>& circle, double offset_mm) {
  if (!circle) return nullptr;
  return {{"center_mm", vector_json(circle->center_mm)},
          {"radius_mm", circle->radius_mm + offset_mm},
          {"deviation_um", in_um(circle->deviation_mm)},
          {"deviation_range_um", range_json(circle->range)},
          {"certificate", certificate_json(circle->certificate)}};
}

Json filtered_json(const std::optional<fit::RoundnessEvaluation>& section) {
  if (!section) return nullptr;
  Json json = {{"filter", fit::name_of(section->filter.filter)},
               {"cutoff_upr", section->filter.cutoff_upr}};
  for (const fit::Roundness& value : section->values) {
    json[fmt::format("{}_um", fit::name_of(value.reference))] = in_um(value.total_mm);
  }
  json["harmonics_um"] = Json::array();
  for (const fit::Harmonic& harmonic : section->harmonics.harmonics) {
    json["harmonics_um"].push_back(in_um(harmonic.amplitude_mm));
  }
  return json;
}

Json layer_json(const evaluation::LayerResult& layer, const evaluation::FeatureResult& feature) {
  const double offset_mm = surface_offset_mm(feature);
  Json json = {{"layer", layer.layer},
               {"height_mm", layer.height_mm},
               {"points", layer.rows.size()},
               {"mz", nullptr},
               {"ls", nullptr},
               {"mc", one_sided_json(layer.mc, offset_mm)},
               {"mi", one_sided_json(layer.mi, offset_mm)},
               {"failure", nullptr}};
  if (layer.mz) {
    json["mz"] = {{"center_mm", vector_json(layer.mz->center_mm)},
                  {"inner_radius_mm", layer.mz->inner_radius_mm + offset_mm},
                  {"outer_radius_mm", layer.mz->outer_radius_mm + offset_mm},
                  {"deviation_um", in_um(layer.mz->width_mm())},
                  {"certificate", certificate_json(layer.mz->certificate)}};
  } else {
    json["failure"] = error_json(layer.mz.error());
  }
  if (layer.ls) {
    json["ls"] = {{"center_mm", vector_json(layer.ls->center_mm)},
                  {"radius_mm", layer.ls->radius_mm + offset_mm},
                  {"deviation_um", in_um(layer.ls->deviation_mm)},
                  {"rms_um", in_um(layer.ls->rms_mm)}};
  }
  json["filtered"] = filtered_json(layer.filtered);
  return json;
}

Json pose_json(const evaluation::PoseValue& pose) {
  return {{"alpha_deg", in_deg(pose.pose.alpha_rad)},
          {"beta_deg", in_deg(pose.pose.beta_rad)},
          {"f_um", pose.valid ? Json(in_um(pose.f_mm)) : Json(nullptr)},
          {"ending", pose.ending},
          {"physical", pose.physical},
          {"final", pose.final_pose}};
}

/// @param merged  The cloud holds several poses.
Json point_json(const evaluation::CloudPoint& point, bool merged) {
  Json json = {{"layer", point.layer},
               {"point", point.point},
               {"repeats", point.repeats},
               {"tip_mm", vector_json(point.tip_mm)},
               {"angle_deg", in_deg(point.angle_rad)},
               {"height_mm", point.height_mm},
               {"deviation_um", in_um(point.deviation_mm)},
               {"contact", point.outer_contact   ? Json("outer")
                           : point.inner_contact ? Json("inner")
                                                 : Json(nullptr)}};
  if (point.pass) json["pass"] = *point.pass;
  if (merged) json["pose"] = point.pose;
  return json;
}

/// Three of the six numbers of a pose, with a factor that converts them to the unit of the key.
Json three_json(const Eigen::Matrix<double, 6, 1>& values, int first, double factor) {
  return {factor * values(first), factor * values(first + 1), factor * values(first + 2)};
}

Json merged_pose_json(const evaluation::MergedPoses& merged, std::size_t k) {
  Json json = {{"alpha_deg", in_deg(merged.poses[k].alpha_rad)},
               {"beta_deg", in_deg(merged.poses[k].beta_rad)},
               {"points", merged.points[k]}};
  if (!merged.solved) return json;
  const fit::PoseErrorFound& found = merged.solved->errors[k];
  json["shift_um"] = three_json(found.error, 0, 1e3);
  json["turn_urad"] = three_json(found.error, 3, 1e6);
  json["u_shift_um"] = three_json(found.u, 0, 1e3);
  json["u_turn_urad"] = three_json(found.u, 3, 1e6);
  json["prior_u_shift_um"] = three_json(found.prior_u, 0, 1e3);
  json["prior_u_turn_urad"] = three_json(found.prior_u, 3, 1e6);
  json["from_kinematics"] = found.from_kinematics;
  return json;
}

Json merged_json(const evaluation::MergedPoses& merged) {
  Json json = {{"merge", merged.joint ? "joint" : "kinematics"},
               {"touch_um", in_um(merged.touch_mm)},
               {"in_words", share_in_words(merged)}};
  if (merged.solved) {
    const fit::PoseJoint& solved = *merged.solved;
    json["kinematics_cylt_um"] = in_um(solved.naive_mm);
    json["joint_cylt_um"] = in_um(solved.joint_mm);
    json["fixture_share_um"] = in_um(solved.share_mm());
    json["u_joint_um"] = solved.u_joint_mm ? Json(in_um(*solved.u_joint_mm)) : Json();
    json["u_kinematics_um"] = in_um(solved.u_naive_mm);
    json["shared_targets"] = solved.shared;
    json["condition"] = solved.condition;
    json["chi2"] = solved.chi2;
    json["chi2_freedom"] = solved.chi2_freedom;
    json["chi2_limit"] = solved.chi2_limit;
    json["statements"] = solved.statements;
  }
  json["refusal"] = optional_json(merged.refusal);
  json["poses"] = Json::array();
  for (std::size_t k = 0; k < merged.poses.size(); ++k)
    json["poses"].push_back(merged_pose_json(merged, k));
  return json;
}

Json levelling_json(const std::optional<core::Pose>& pose) {
  if (!pose) return nullptr;
  return {{"alpha_deg", in_deg(pose->alpha_rad)}, {"beta_deg", in_deg(pose->beta_rad)}};
}

Json thermal_json(const std::optional<evaluation::ThermalCorrection>& c) {
  if (!c) return nullptr;
  return {{"part_expansion_per_K", c->part_expansion_1_K},
          {"scale_expansion_per_K", c->scale_expansion_1_K},
          {"part_degC", c->part_degC},
          {"scale_degC", c->scale_degC},
          {"factor", c->factor},
          {"factor_standard_uncertainty", c->factor_uncertainty}};
}

/// All but the rows of the cloud.
Json feature_json(const evaluation::FeatureResult& feature) {
  if (record::is_analysis(feature.feature.shape)) return analysis_json(feature);
  const record::Feature& asked = feature.feature;
  Json json;
  json["id"] = asked.id;
  json["shape"] = record::name_of(asked.shape);
  json["side"] = record::name_of(asked.side);
  json["nominal_diameter_mm"] = asked.nominal_diameter_mm;
  json["strategy"] = record::name_of(asked.strategy);
  json["planned_layers"] = asked.layers;
  json["planned_points_per_layer"] = asked.points_per_layer;
  json["points_file"] = asked.points_file;
  json["points_sha256"] = asked.points_sha256;
  json["points"] = feature.cloud.size();
  json["characteristics"] = characteristics_json(feature);
  if (!feature.gates.empty()) json["gates"] = gates_json(feature.gates);
  json["mz"] = zone_json(feature);
  json["ls"] = least_squares_json(feature);
  json["mc"] = one_sided_json(feature, record::Reference::kMinimumCircumscribed);
  json["mi"] = one_sided_json(feature, record::Reference::kMaximumInscribed);
  json["tip_radius_mm"] = optional_json(feature.tip_radius_mm);
  json["levelling_pose"] = levelling_json(feature.levelling_pose);
  json["repeat_sigma_um"] = optional_um(feature.repeat_sigma_mm);
  json["repeat_zone_mean_um"] = optional_um(feature.repeat_zone_mean_mm);
  json["repeat_zone_sd_um"] = optional_um(feature.repeat_zone_sd_mm);
  json["mean_temperature_degC"] =
      feature.temperatures ? Json(feature.temperatures->mean_degC) : Json(nullptr);
  json["temperature_source"] = !feature.temperatures            ? Json(nullptr)
                               : feature.temperatures->declared ? Json("declared")
                                                                : Json("measured");
  json["temperature_correction"] = thermal_json(feature.thermal);
  json["layers"] = list_json(feature.layers, [&](const evaluation::LayerResult& layer) {
    return layer_json(layer, feature);
  });
  json["poses"] = list_json(feature.poses, pose_json);
  if (feature.merged) json["merged"] = merged_json(*feature.merged);
  json["cloud"] = Json::array();
  json["warnings"] = list_json(feature.warnings, error_json);
  json["failure"] = optional_json(feature.failure);
  return json;
}

Json event_json(const record::Decision& decision) {
  Json json = {{"feature", decision.feature < 0 ? Json(nullptr) : Json(decision.feature)},
               {"time_s", decision.time_s},
               {"text", english_sentence(decision.message)}};
  const core::Message& message = decision.message;
  Json arguments = Json::object();
  const auto kinds = core::arguments_of(message.code);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    std::visit([&](const auto& value) { arguments[std::string(kinds[i].name)] = value; },
               message.arguments.at(i));
  }
  json["code"] = core::message_name(message.code);
  json["arguments"] = std::move(arguments);
  return json;
}

bool any_interval(const evaluation::Evaluation& evaluation) {
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& c : feature.characteristics) {
      if (c.value && c.value->uncertainty().result()) return true;
    }
  }
  return false;
}

constexpr int kIndent = 1;
constexpr int kDepthOfRow = 4;  // root, features, feature, cloud

/// Names come from plans and command lines: bytes that are not UTF-8 are replaced, not refused.
std::string dumped(const Json& json) {
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace);
}

/// Adds the rows of a cloud between the brackets of its list.
void add_rows(const evaluation::FeatureResult& feature, std::string& out) {
  const std::string line = "\n" + std::string(kIndent * kDepthOfRow, ' ');
  for (std::size_t i = 0; i < feature.cloud.size(); ++i) {
    out += i == 0 ? line : "," + line;
    for (const char c : dumped(point_json(feature.cloud[i], feature.merged != nullptr))) {
      if (c == '\n') {
        out += line;
      } else {
        out += c;
      }
    }
  }
  if (!feature.cloud.empty()) out += "\n" + std::string(kIndent * (kDepthOfRow - 1), ' ');
}

Json correction_json(const CorrectionFile& one) {
  return {{"file", one.file}, {"kind", one.kind}, {"format", record::name_of(one.format)}};
}

/// Adds to the analyses what they hand on to machines. The results in the journal lack it: a table
/// is no result.
void add_corrections(const evaluation::Evaluation& evaluation,
                     const std::vector<FeatureCorrections>& corrections, Json& features) {
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    if (!record::is_analysis(evaluation.features[i].feature.shape)) continue;
    const FeatureCorrections& one = corrections[i];
    features[i]["corrections"] = list_json(one.files, correction_json);
    features[i]["no_correction_because"] =
        one.none_because.empty() ? Json(nullptr) : Json(one.none_because.english());
  }
}

Json document_of(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                 const std::vector<FeatureCorrections>& corrections) {
  Json json;
  json["schema_version"] = 1;
  json["header"] = header_json(record);
  json["verdict"] = name_of(evaluation.verdict);
  json["measurement_uncertainty"] =
      any_interval(evaluation) ? Json("stated with each characteristic") : Json(nullptr);
  json["rule"] = rule_json(evaluation);
  Json results = results_json(evaluation);
  json["probe"] = std::move(results["probe"]);
  json["fixture_calibration"] = fixture_json(evaluation.fixture);
  json["features"] = std::move(results["features"]);
  add_corrections(evaluation, corrections, json["features"]);
  json["decisions"] = list_json(record.decisions, event_json);
  json["simulation"] = Json::array();
  for (const record::TruthValue& truth : record.truth_values) {
    json["simulation"].push_back({{"feature", truth.feature}, {truth.name, truth.value}});
  }
  return json;
}

}  // namespace

Json results_json(const evaluation::Evaluation& evaluation) {
  return {{"probe", probe_json(evaluation.probe)},
          {"features", list_json(evaluation.features, feature_json)}};
}

std::string write_json(const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                       const std::vector<FeatureCorrections>& corrections) {
  // The rows are text one by one: as a document, those of a million points take a gigabyte.
  const std::string rest = dumped(document_of(record, evaluation, corrections)) + "\n";
  const std::string empty = "\n" + std::string(kIndent * (kDepthOfRow - 1), ' ') + "\"cloud\": []";
  std::string out;
  std::size_t done = 0;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    if (record::is_analysis(feature.feature.shape)) continue;  // it has none
    const std::size_t at = rest.find(empty, done) + empty.size() - 1;
    out.append(rest, done, at - done);
    add_rows(feature, out);
    done = at;
  }
  return out.append(rest, done);
}

}  // namespace rondure::reports
