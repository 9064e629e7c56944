#include "synthetic.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/html/report.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

constexpr double kTip = 1.4986;
constexpr double kRadius = 25.0;
constexpr double kHalfZone = 0.00415;

record::Header header() {
  record::Header h;
  h.run_id = "01_spool_simulated-20261121T023302Z";
  h.version = "0.1.0";
  h.processor = "Example CPU 3000, AVX2";
  h.started_utc = "2026-11-21T02:33:02Z";
  h.plan_file = "01_spool_simulated.json";
  h.plan_name = "Valve spool, land A";
  h.plan_revision = "C";
  h.plan_sha256 = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08";
  h.part_id = "VS-1180";
  h.part_name = "Valve spool";
  h.drawing = "D-4711-02";
  h.serial = "0042";
  h.operator_name = "M. Example";
  h.machine = "simulated CMM";
  h.fixture = "simulated two-axis fixture, resolution 0.05 deg";
  h.decision_rule = "simple-acceptance";
  h.simulated = true;
  h.seed = 20261121;
  h.temperature_min_degC = 19.0;
  h.temperature_max_degC = 21.0;
  return h;
}

/// Deviations of a three-lobed, slightly barrelled part with noise, within +-kHalfZone; six points
/// touch the zone.
std::vector<evaluation::CloudPoint> cloud(int layers, int points, bool several_repeats) {
  core::KeyedNoise noise(7, {1});
  std::vector<evaluation::CloudPoint> result;
  for (int layer = 0; layer < layers; ++layer) {
    for (int point = 0; point < points; ++point) {
      evaluation::CloudPoint p;
      p.layer = layer;
      p.point = point;
      p.repeats = several_repeats ? 3 : 1;
      p.angle_rad = core::kTwoPi * (point + 0.03) / points;
      p.height_mm = layers == 1 ? 0.0 : -24.0 + 48.0 * layer / (layers - 1);
      const double form = 0.55 * std::cos(3.0 * p.angle_rad + 0.02 * p.height_mm) -
                          0.3 * std::cos(p.height_mm / 10.0) + 0.12 * noise.normal();
      p.deviation_mm = kHalfZone * std::clamp(form, -0.96, 0.96);
      const double r = kRadius + kTip + p.deviation_mm;
      p.tip_mm = {r * std::cos(p.angle_rad), r * std::sin(p.angle_rad), 40.0 + p.height_mm};
      result.push_back(p);
    }
  }
  const std::size_t n = result.size();
  for (std::size_t k = 0; k < 6; ++k) {
    evaluation::CloudPoint& p = result[(2 * k + 1) * n / 12];
    (k % 2 == 0 ? p.outer_contact : p.inner_contact) = true;
    p.deviation_mm = k % 2 == 0 ? kHalfZone : -kHalfZone;
  }
  return result;
}

void add_contacts(const std::vector<evaluation::CloudPoint>& points,
                  std::vector<fit::Contact>& outer, std::vector<fit::Contact>& inner) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].outer_contact) outer.push_back({i, 1.0 / 3.0});
    if (points[i].inner_contact) inner.push_back({i, 1.0 / 3.0});
  }
}

fit::MinZoneCircle zone_circle(double mean_mm, double half_mm) {
  fit::MinZoneCircle circle;
  circle.center_mm = {0.0123456, -0.0065432};
  circle.inner_radius_mm = mean_mm - half_mm;
  circle.outer_radius_mm = mean_mm + half_mm;
  circle.certificate = {fit::Certificate::Kind::kGlobal, core::phrase("all centres"), 2.1e-13, {}};
  return circle;
}

void add_layers(evaluation::FeatureResult& feature, int layers, int points, double mean_mm) {
  for (int layer = 0; layer < layers; ++layer) {
    evaluation::LayerResult result;
    result.layer = layer;
    for (int point = 0; point < points; ++point) {
      result.rows.push_back(static_cast<std::size_t>(layer * points + point));
    }
    result.height_mm = feature.cloud[result.rows.front()].height_mm;
    result.mz = zone_circle(mean_mm, kHalfZone * (0.6 + 0.08 * layer / layers));
    result.ls = fit::LsCircle{{0.012, -0.006}, mean_mm, 0.0071, 0.0019};
    feature.layers.push_back(std::move(result));
  }
}

/// f falls from 2 mm by halving steps towards the final pose.
void add_poses(record::RunRecord& record, evaluation::FeatureResult& feature, int poses) {
  for (int i = 0; i < poses; ++i) {
    evaluation::PoseValue value;
    const double left = poses == 1 ? 0.0 : 1.0 - static_cast<double>(i) / (poses - 1);
    const double turn = 2.4 * i;
    value.pose = {(1.20 + 4.0 * left * left * std::cos(turn)) * core::kDegree,
                  (-0.85 + 4.0 * left * left * std::sin(turn)) * core::kDegree};
    value.f_mm = 0.00835 + 2.0 * std::pow(left, 3.0);
    value.valid = true;
    value.ending = i % 2 == 0 ? "cross" : "spoke";
    value.physical = i % 5 != 3;
    value.final_pose = i + 1 == poses;
    feature.poses.push_back(value);
    record.poses.push_back({i, 0, value.pose, value.pose, value.final_pose, 10.0 * i});
  }
}

void add_touches(record::RunRecord& record, const evaluation::FeatureResult& feature) {
  std::int64_t id = 0;
  for (int i = 0; i < 5; ++i) {
    record::Touch touch;
    touch.id = id++;
    touch.purpose = record::Touch::Purpose::kQualification;
    touch.tip_mm = {100.1 + i, 0.1, 11.5};
    touch.approach = {0.0, 0.0, -1.0};
    record.touches.push_back(touch);
  }
  for (const evaluation::CloudPoint& point : feature.cloud) {
    record::Touch touch;
    touch.id = id++;
    touch.pose = record.poses.empty() ? 0 : record.poses.back().id;
    touch.layer = point.layer;
    touch.point = point.point;
    touch.tip_mm = point.tip_mm;
    touch.approach = {-std::cos(point.angle_rad), -std::sin(point.angle_rad), 0.0};
    touch.temperature_degC = 20.1;
    touch.time_s = 0.7 * static_cast<double>(id);
    record.touches.push_back(touch);
  }
}

record::Feature land(int layers, int points) {
  record::Feature feature;
  feature.id = "land-A";
  feature.nominal_diameter_mm = 50.0;
  feature.layers = layers;
  feature.points_per_layer = points;
  feature.strategy =
      layers * points > 0 ? record::Strategy::kGuided : record::Strategy::kPointsFile;
  feature.characteristics.push_back(
      {"cyl-A", record::Form::kCylindricity, record::Reference::kMinimumZone, 0.010, "B3"});
  return feature;
}

/// A value with its operator and without an interval.
evaluation::StatedValue stated(const record::Characteristic& asked, double value_mm,
                               const core::Phrase& sampling) {
  return {symbol_of(asked), value_mm,
          evaluation::ValueOperator(evaluation::ReferenceTerm(core::as_it_is(reference_of(asked))),
                                    evaluation::FilterTerm(core::phrase("unfiltered")),
                                    evaluation::SamplingTerm(sampling),
                                    evaluation::TipTerm(core::phrase("r_tip {:.4f} mm", 1.4986)),
                                    evaluation::TemperatureTerm(core::as_it_is("20.12 degC"))),
          evaluation::UncertaintyStatus::none(core::phrase("the plan declares no uncertainty"))};
}

/// A decision with these words.
core::Message decided(const std::string& words) {
  return {core::MessageCode::kLevelPoseUnreachable, {words}};
}

}  // namespace

Case cylinder_case(int layers, int points_per_layer, int poses) {
  Case made;
  made.record.header = header();
  made.record.ending = "finished";
  made.record.artefact = {12.5, 1.5, 0.005, 0.003};
  made.record.features.push_back(land(layers, points_per_layer));
  made.record.decisions = {
      {-1, 41.2, {core::MessageCode::kSingleSteps, {10.0}}},
      {0, 118.4, {core::MessageCode::kPartLocated, {0.0, 0.0, 1.2031, -0.848}}},
      {0, 240.9, {core::MessageCode::kLevelToResolution, {1.2031, -0.848, 8.3, 0.02, 0.05}}}};
  evaluation::FeatureResult feature;
  feature.feature = made.record.features.front();
  feature.cloud = cloud(layers, points_per_layer, true);
  const double mean_mm = kRadius + kTip;
  fit::MinZoneCylinder zone;
  zone.axis = {{0.012, -0.0065, 40.0}, {0.0000123, -0.0000214, 1.0}};
  zone.inner_radius_mm = mean_mm - kHalfZone;
  zone.outer_radius_mm = mean_mm + kHalfZone;
  add_contacts(feature.cloud, zone.outer, zone.inner);
  zone.certificate = {fit::Certificate::Kind::kLocal,
                      core::Phrase("next to the least-squares axis"), 4.2e-13,
                      core::Phrase("the global proof covers up to 40 points of one section")};
  feature.mz_cylinder = zone;
  feature.ls_cylinder = fit::LsCylinder{zone.axis, mean_mm + 0.0002, 0.00912, 0.00203};
  add_layers(feature, layers, points_per_layer, mean_mm);
  add_poses(made.record, feature, poses);
  feature.tip_radius_mm = kTip;
  feature.levelling_pose = core::Pose{1.2031 * core::kDegree, -0.848 * core::kDegree};
  feature.repeat_sigma_mm = 0.00031;
  feature.repeat_zone_mean_mm = 0.00882;
  feature.repeat_zone_sd_mm = 0.00014;
  feature.temperatures = evaluation::Temperatures{20.1, 20.14, 20.12};
  feature.characteristics.push_back(
      {feature.feature.characteristics.front(),
       stated(
           feature.feature.characteristics.front(), 2.0 * kHalfZone,
           core::Phrase(fmt::format("{} x {} points, 3 touches each", layers, points_per_layer))),
       evaluation::Verdict::kConforms,
       core::Phrase("8.300 um is not above the limit of 10.000 um."),
       {},
       {}});
  add_touches(made.record, feature);
  made.evaluation.features.push_back(std::move(feature));
  made.evaluation.probe = fit::ProbeTip{{100.0, 0.0, 0.0}, kTip, 0.00011, 0.2, 0.0009};
  made.evaluation.verdict = evaluation::Verdict::kConforms;
  return made;
}

Case failing_case() {
  Case made = cylinder_case(4, 7, 3);
  evaluation::FeatureResult& feature = made.evaluation.features.front();
  evaluation::CharacteristicResult& result = feature.characteristics.front();
  result.characteristic.tolerance_mm = 0.006;
  result.verdict = evaluation::Verdict::kDoesNotConform;
  result.reason = core::Phrase("8.300 um is 2.300 um above the limit of 6.000 um.");
  record::Characteristic round{"round-A", record::Form::kRoundness,
                               record::Reference::kLeastSquares, 0.012, ""};
  feature.characteristics.push_back(
      {round,
       stated(round, 0.0071, core::Phrase("worst of 4 layers")),
       evaluation::Verdict::kConforms,
       core::Phrase("7.100 um in layer 3 is not above the limit of 12.000 um."),
       {},
       {}});
  record::Characteristic reported{
      "cyl-LS", record::Form::kCylindricity, record::Reference::kLeastSquares, {}, ""};
  feature.characteristics.push_back(
      {reported,
       stated(reported, 0.00912, core::phrase("{} x {} points", 4, 7)),
       evaluation::Verdict::kNotToleranced,
       core::Phrase("Reported only."),
       {},
       {}});
  feature.warnings.push_back({core::Code::kSparse,
                              "7 points a layer do not show lobes above the third; 15 or more do.",
                              "/features/0/sampling"});
  feature.warnings.push_back(
      {core::Code::kNotLevel, "f is 20.1 um, above twice the minimum zone of 8.300 um.", ""});
  made.evaluation.verdict = evaluation::Verdict::kDoesNotConform;
  return made;
}

Case circle_case(int points) {
  Case made;
  made.record.header = header();
  made.record.header.simulated = false;
  made.record.header.machine = "";
  made.record.header.fixture = "";
  made.record.ending = "finished";
  record::Feature asked = land(0, 0);
  asked.id = "journal-3";
  asked.shape = record::Shape::kCircle;
  asked.strategy = record::Strategy::kPointsFile;
  asked.points_file = "pin3.csv";
  asked.points_sha256 = made.record.header.plan_sha256;
  asked.characteristics = {
      {"round-3", record::Form::kRoundness, record::Reference::kMinimumZone, 0.012, ""}};
  made.record.features.push_back(asked);
  evaluation::FeatureResult feature;
  feature.feature = asked;
  feature.cloud = cloud(1, points, false);
  evaluation::LayerResult section;
  for (std::size_t i = 0; i < feature.cloud.size(); ++i) section.rows.push_back(i);
  section.mz = zone_circle(kRadius, kHalfZone);
  add_contacts(feature.cloud, section.mz->outer, section.mz->inner);
  section.ls = fit::LsCircle{{0.012, -0.006}, kRadius, 0.00871, 0.0019};
  feature.layers.push_back(section);
  feature.characteristics.push_back(
      {asked.characteristics.front(),
       stated(asked.characteristics.front(), 2.0 * kHalfZone, core::phrase("points as given")),
       evaluation::Verdict::kConforms,
       core::Phrase("8.300 um is not above the limit of 12.000 um."),
       {},
       {}});
  add_touches(made.record, feature);
  made.evaluation.features.push_back(std::move(feature));
  made.evaluation.verdict = evaluation::Verdict::kConforms;
  return made;
}

Case spiral_case(int points) {
  Case made = cylinder_case(1, points, 1);
  record::Feature& asked = made.record.features.front();
  asked.layers = 0;
  asked.points_per_layer = 0;
  asked.strategy = record::Strategy::kPointsFile;
  asked.points_file = "spiral.csv";
  made.record.poses.clear();
  made.evaluation.probe.reset();
  evaluation::FeatureResult& feature = made.evaluation.features.front();
  feature.feature = asked;
  feature.layers.clear();
  feature.poses.clear();
  feature.tip_radius_mm.reset();
  feature.levelling_pose.reset();
  feature.repeat_sigma_mm.reset();
  feature.repeat_zone_mean_mm.reset();
  feature.repeat_zone_sd_mm.reset();
  for (std::size_t i = 0; i < feature.cloud.size(); ++i) {
    evaluation::CloudPoint& point = feature.cloud[i];
    point.angle_rad = std::fmod(0.61 * static_cast<double>(i), core::kTwoPi);
    point.height_mm = 50.0 * static_cast<double>(i) / points - 25.0;
    const double r = kRadius + kTip + point.deviation_mm;
    point.tip_mm = {r * std::cos(point.angle_rad), r * std::sin(point.angle_rad),
                    40.0 + point.height_mm};
  }
  return made;
}

Case unfinished_case() {
  Case made = cylinder_case(4, 7, 3);
  made.record.ending = "failed: collision";
  made.record.failure = core::Error{
      core::Code::kCollision, "The probe met something 3.1 mm before its target.", "/features/1"};
  record::Feature second = land(3, 9);
  second.id = "bore-B";
  second.side = record::Side::kInside;
  made.record.features.push_back(second);
  evaluation::FeatureResult feature;
  feature.feature = second;
  feature.failure =
      core::Error{core::Code::kNoPoints, "No cloud of a final pose is on record.", ""};
  feature.characteristics.push_back({second.characteristics.front(),
                                     {},
                                     evaluation::Verdict::kVoid,
                                     core::Phrase("There is no value."),
                                     {},
                                     {}});
  made.evaluation.features.push_back(feature);
  made.evaluation.verdict = evaluation::Verdict::kVoid;
  return made;
}

Case hostile_case(const std::string& text) {
  Case made = failing_case();
  record::Header& h = made.record.header;
  for (std::string* name :
       {&h.run_id, &h.version, &h.processor, &h.started_utc, &h.plan_file, &h.plan_name,
        &h.plan_revision, &h.plan_sha256, &h.part_id, &h.part_name, &h.drawing, &h.serial,
        &h.operator_name, &h.machine, &h.fixture, &h.decision_rule, &made.record.ending}) {
    *name = text;
  }
  made.record.failure = core::Error{core::Code::kMachine, text, text};
  for (record::Decision& decision : made.record.decisions) decision.message = decided(text);
  made.record.features.front().id = text;
  evaluation::FeatureResult& feature = made.evaluation.features.front();
  feature.feature.id = text;
  feature.feature.points_file = text;
  feature.failure = core::Error{core::Code::kRank, text, text};
  feature.mz_cylinder->certificate.scope = core::Phrase(text);
  feature.mz_cylinder->certificate.reason = core::Phrase(text);
  for (evaluation::PoseValue& pose : feature.poses) pose.ending = text;
  for (core::Error& warning : feature.warnings) warning = {warning.code, text, text};
  for (evaluation::CharacteristicResult& result : feature.characteristics) {
    const core::Phrase said(text);
    result.characteristic.id = text;
    result.characteristic.drawing_zone = text;
    result.reason = core::Phrase(text);
    result.value.emplace(
        text, 0.0083,
        evaluation::ValueOperator(evaluation::ReferenceTerm(said), evaluation::FilterTerm(said),
                                  evaluation::SamplingTerm(said), evaluation::TipTerm(said),
                                  evaluation::TemperatureTerm(said)),
        evaluation::UncertaintyStatus::none(said));
  }
  return made;
}

namespace {

/// A characteristic with its finding, which carries the value.
evaluation::CharacteristicResult found_result(record::Characteristic asked,
                                              evaluation::Finding finding,
                                              evaluation::Verdict verdict) {
  finding.reference = core::as_it_is("GN");
  finding.filter = core::phrase("unfiltered");
  const evaluation::JudgedValue& first = finding.judged.front();
  evaluation::StatedValue value(
      first.symbol, first.value_mm,
      evaluation::ValueOperator(evaluation::ReferenceTerm(finding.reference),
                                evaluation::FilterTerm(finding.filter),
                                evaluation::SamplingTerm(core::phrase("{} x {} points", 4, 7)),
                                evaluation::TipTerm(core::phrase("r_tip {:.4f} mm", 1.4986)),
                                evaluation::TemperatureTerm(core::as_it_is("20.12 degC"))),
      evaluation::UncertaintyStatus::none(core::phrase("the plan declares no uncertainty")),
      evaluation::Measurand::kSampledPoints, evaluation::unit_of(asked));
  evaluation::CharacteristicResult result{
      std::move(asked), std::move(value), verdict, core::Phrase("As the limits say."), {}, {}};
  result.finding = std::make_shared<const evaluation::Finding>(std::move(finding));
  return result;
}

}  // namespace

Case drawing_case() {
  using evaluation::LocalValue;
  using Indication = record::Indication;
  Case made = cylinder_case(4, 7, 3);
  evaluation::FeatureResult& journal = made.evaluation.features.front();

  record::Characteristic envelope{"50h6 E", record::Form::kDiameter, {}, 50.0, ""};
  envelope.lower_mm = 49.984;
  envelope.indication.requirement = Indication::Requirement::kEnvelope;
  evaluation::Finding mating;
  mating.judged = {{"d GN", 50.0012, {{}, 50.0}}, {"d LP SN", 49.9931, {49.984, {}}}};
  journal.characteristics.push_back(
      found_result(envelope, mating, evaluation::Verdict::kDoesNotConform));

  record::Characteristic mean = envelope;
  mean.id = "50h6 mean";
  mean.indication = {};
  mean.indication.size = Indication::Size::kGG;
  mean.indication.section = Indication::Section::kACS;
  evaluation::Finding sections;
  sections.judged = {{"d GG", 49.9955, {49.984, 50.0}}};
  for (int layer = 0; layer < 4; ++layer) {
    sections.local.push_back(
        {LocalValue::Place::kLayer, layer, 5.0 + 10.0 * layer, 49.9955 + 0.0004 * layer});
  }
  sections.local[2].none = core::Error{core::Code::kSparse, "2 points are left", ""};
  sections.numbers = {{"SA", 49.9958}, {"pairs", 12.0, false}};
  sections.left_out = {{3, "keyway"}, {4, "keyway"}, {9, ""}};
  journal.characteristics.push_back(found_result(mean, sections, evaluation::Verdict::kConforms));

  record::Characteristic turns{"run-out", record::Form::kRunOut, {}, 0.015, ""};
  turns.indication.datum = {"A-B"};
  turns.indication.filter = Indication::Filter::kGaussian;
  turns.indication.cutoff_upr = 50.0;
  evaluation::Finding circles;
  circles.judged = {{"Run-out", 0.0121, {{}, 0.015}}};
  circles.local = {{LocalValue::Place::kLayer, 0, 5.0, 0.0093},
                   {LocalValue::Place::kLayer, 1, 15.0, 0.0121}};
  circles.worst = 1;
  circles.about_equalised_mm = {0.0113};
  circles.lines = {{0.5, {1.0, 2.0}, {0.001, -0.001}}};
  evaluation::DatumResult common;
  common.name = "A-B";
  common.radii_mm = {26.5, 26.5};
  common.features = {0, 1};
  common.length_mm = 40.0;
  common.play_mm = 0.0078;
  common.equalised = fit::Axis{{0.001, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  circles.datums = {common};
  journal.characteristics.push_back(found_result(turns, circles, evaluation::Verdict::kConforms));

  evaluation::FeatureResult face;
  face.feature = made.record.features.front();
  face.feature.id = "face-B";
  face.feature.shape = record::Shape::kPlane;
  face.feature.characteristics.clear();
  face.cloud = journal.cloud;
  face.ls_plane = fit::LsPlane{{{0.0, 0.0, 60.0}, {0.0, 0.0, 1.0}}, 0.0031, 0.0008};
  face.mz_plane = fit::MinZonePlane{};
  face.mz_plane->outer = {{0.0, 0.0, 60.0015}, {0.0, 0.0, 1.0}};
  face.mz_plane->width_mm = 0.0029;
  face.tip_radius_mm = kTip;
  record::Characteristic flat{"flat", record::Form::kFlatness, record::Reference::kMinimumZone,
                              0.004, ""};
  evaluation::Finding zone;
  zone.judged = {{"FLTt", 0.0029, {{}, 0.004}}};
  face.characteristics.push_back(found_result(flat, zone, evaluation::Verdict::kConforms));
  record::Characteristic square{"square", record::Form::kPerpendicularity, {}, 0.008, ""};
  square.indication.datum = {"A"};
  evaluation::Finding right;
  right.judged = {{"PER", 0.0051, {{}, 0.008}}};
  right.datums = {common};
  right.datums[0].name = "A";
  right.datums[0].features = {0};
  face.characteristics.push_back(found_result(square, right, evaluation::Verdict::kConforms));
  made.record.features.push_back(face.feature);
  for (auto* feature : {&journal, &face}) {
    auto& asked = made.record.features[feature == &journal ? 0 : 1].characteristics;
    asked.clear();
    for (const auto& result : feature->characteristics) asked.push_back(result.characteristic);
    feature->feature.characteristics = asked;
  }
  made.evaluation.features.push_back(std::move(face));
  made.evaluation.verdict = evaluation::Verdict::kDoesNotConform;
  return made;
}

std::string page_of(const Case& made) { return write_html(made.record, made.evaluation); }

}  // namespace rondure::reports
