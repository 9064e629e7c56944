#include "evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "core/watch.h"
#include "evaluation/analysis.h"
#include "evaluation/defect.h"
#include "evaluation/handed_calibration.h"
#include "evaluation/internal/conformance.h"
#include "evaluation/internal/merged.h"
#include "evaluation/internal/touched_surface.h"
#include "evaluation/internal/truth.h"
#include "evaluation/internal/warnings.h"
#include "evaluation/invariants.h"
#include "evaluation/part/internal/families.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/internal/fixture_use.h"
#include "evaluation/results/measured_cloud.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "fit/poses/walk.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using record::RunRecord;
using record::Touch;

/// f of every measured pose, from its own touches.
void evaluate_poses(const RunRecord& record, int index, FeatureResult& result) {
  if (result.feature.strategy == record::Strategy::kPointsFile) return;
  for (const record::PoseVisit& visit : record.poses) {
    if (visit.feature != index) continue;
    const auto value = value_of_pose(record, visit, result.feature.strategy);
    if (value) result.poses.push_back(*value);
  }
}

/// The software search of the strategy `virtual`: one cloud, rotated.
void search_virtual_poses(const record::PoseVisit& visit, FeatureResult& result) {
  const Eigen::Matrix3d back = rotation(visit.reached).transpose();
  const auto tips = tips_of(result.cloud);
  std::vector<PoseValue> values;
  const auto f = [&](const core::Pose& pose) -> core::Result<double> {
    PoseValue value = pose_value(projected(tips, rotation(pose) * back), result.feature.strategy);
    if (!value.valid) return core::fail(core::Code::kPoseRange, value.ending);
    value.pose = pose;
    value.physical = false;
    values.push_back(value);
    return value.f_mm;
  };
  const auto walk = fit::walk_poses(f, visit.reached, result.feature.search_steps_deg);
  if (!walk) {
    result.warnings.push_back(walk.error());
    return;
  }
  for (PoseValue& value : values) {
    value.final_pose = value.pose == walk->visited[walk->best].pose;
  }
  for (PoseValue& value : result.poses) value.final_pose = false;
  result.poses.insert(result.poses.end(), values.begin(), values.end());
}

/// Sets angle, height and deviation of every point about an axis.
void place_points(const fit::Axis& axis, double middle_radius_mm, const Eigen::Vector3d& mean,
                  FeatureResult& result) {
  const bool down = axis.direction.dot(result.part_turn.col(2)) < 0.0;
  const Eigen::Vector3d z = down ? Eigen::Vector3d(-axis.direction) : axis.direction;
  const auto frame = frame_of_angles(result, axis.direction);
  const Eigen::Vector3d x = frame.col(0);
  const Eigen::Vector3d y = frame.col(1);
  for (CloudPoint& point : result.cloud) {
    const Eigen::Vector3d v = point.tip_mm - axis.point_mm;
    const double u = v.dot(x);
    const double w = v.dot(y);
    point.angle_rad = std::atan2(w, u);
    if (point.angle_rad < 0.0) point.angle_rad += core::kTwoPi;
    point.height_mm = (point.tip_mm - mean).dot(z);
    point.deviation_mm = std::hypot(u, w) - middle_radius_mm;
  }
}

/// Points of a section. Only the first of several passes is used: neighbouring points of two passes
/// differ by their noise, which a curve through both would amplify.
std::vector<Eigen::Vector2d> first_pass(const std::vector<CloudPoint>& cloud,
                                        const std::vector<std::size_t>& rows,
                                        const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (cloud[rows[i]].pass == cloud[rows.front()].pass) out.push_back(points[i]);
  }
  return out;
}

/// The filtered section of a dense layer; the verdict uses the points as measured.
std::optional<fit::RoundnessEvaluation> dense_section(const std::vector<Eigen::Vector2d>& points) {
  constexpr std::size_t kDense = 7 * 50;   // points at the cut-off of 50 UPR
  constexpr std::size_t kAtMost = 10'000;  // a file may hold far more; this is for display only
  if (points.size() < kDense || points.size() > kAtMost) return std::nullopt;
  auto section = fit::evaluate_section(points, {});
  if (!section) return std::nullopt;  // an arc, or gaps: there is no filtered profile
  return *std::move(section);
}

/// Sections normal to an axis, by layer.
std::vector<LayerResult> sections(const fit::Axis& axis, const std::vector<CloudPoint>& cloud) {
  std::map<int, std::vector<std::size_t>> layers;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud[i].left_out) layers[cloud[i].layer].push_back(i);
  }
  const auto frame = fit::across(axis.direction);
  std::vector<LayerResult> out;
  for (const auto& [layer, rows] : layers) {
    std::vector<Eigen::Vector2d> section;
    double height = 0.0;
    for (const std::size_t i : rows) {
      section.emplace_back(frame.transpose() * (cloud[i].tip_mm - axis.point_mm));
      height += cloud[i].height_mm / static_cast<double>(rows.size());
    }
    LayerResult result{layer, height, rows, fit::min_zone_circle(section), fit::ls_circle(section)};
    result.mc = fit::min_circumscribed_circle(section);
    result.mi = fit::max_inscribed_circle(section);
    result.filtered = dense_section(first_pass(cloud, rows, section));
    result.points_mm = std::move(section);
    out.push_back(std::move(result));
  }
  return out;
}

Eigen::Vector3d mean_of(const std::vector<CloudPoint>& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& point : cloud) sum += point.tip_mm - cloud.front().tip_mm;
  return cloud.front().tip_mm + sum / static_cast<double>(cloud.size());
}

/// The normal of the points of a circle of a file, upward; z where its lean moves no point by
/// 10 nm, as the noise of the heights of a level one does.
Eigen::Vector3d normal_of_circle(const std::vector<CloudPoint>& cloud) {
  constexpr double kSeen_mm = 1e-5;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d normal =
      fit::layer_normal(tips_of(cloud), std::vector<int>(cloud.size(), 0)).value_or(up);
  if (normal.z() < 0.0) normal = -normal;
  const Eigen::Vector3d middle = mean_of(cloud);
  const bool leans = std::ranges::any_of(cloud, [&](const CloudPoint& point) {
    const auto off = [&](const Eigen::Vector3d& axis) {
      return fit::distance_mm({middle, axis}, point.tip_mm);
    };
    return std::abs(off(normal) - off(up)) > kSeen_mm;
  });
  return leans ? normal : up;
}

/// Expected direction of the axis of a feature, or of the outward normal of a plane, machine frame.
/// A touched part stands as planned (part_turn) or as it was located; points of a file may have any
/// orientation, which their layers show; a circle of a file lies in the plane of its points, unless
/// the plan says z, and a plane as its feature says.
std::optional<Eigen::Vector3d> expected_axis(const RunRecord& record, const FeatureResult& result,
                                             const record::PoseVisit& visit) {
  const record::Feature& feature = result.feature;
  const bool circle = feature.shape == record::Shape::kCircle;
  const auto settings = record::task_of<record::SurfaceSettings>(feature.settings);
  std::optional<Eigen::Vector3d> faces;
  if (settings && settings->faces) {
    faces = *settings->faces == record::Faces::kUp ? Eigen::Vector3d::UnitZ()
                                                   : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
  }
  if (feature.strategy == record::Strategy::kPointsFile) {
    if (faces) return faces;
    if (circle && stated_plane(feature) == "nominal") return Eigen::Vector3d::UnitZ();
    if (circle) return normal_of_circle(result.cloud);
    std::vector<int> layers;
    for (const CloudPoint& point : result.cloud) layers.push_back(point.layer);
    if (std::ranges::adjacent_find(layers, std::not_equal_to()) == layers.end()) return {};
    return fit::layer_normal(tips_of(result.cloud), layers);
  }
  const Eigen::Matrix3d& turn = result.part_turn;
  const Eigen::Vector3d nominal = turn * faces.value_or(Eigen::Vector3d::UnitZ());
  if (!circle) return nominal;
  // One section shows no tilt; the touches that located the part do. Use the last ones before the
  // section, since the part may have been located again.
  for (auto other_at = record.poses.rbegin(); other_at != record.poses.rend(); ++other_at) {
    const record::PoseVisit& other = *other_at;
    if (other.feature != visit.feature || other.id > visit.id) continue;
    std::vector<Eigen::Vector3d> tips;
    for (const Touch& touch : record.touches) {
      if (touch.purpose == Touch::Purpose::kLocate && touch.pose == other.id)
        tips.push_back(touch.tip_mm);
    }
    if (tips.empty()) continue;
    const Eigen::Matrix3d back = part_turn(record, other);
    const auto located = fit::ls_cylinder(tips, back * Eigen::Vector3d::UnitZ());
    if (located) return turn * back.transpose() * located->axis.direction;
  }
  return nominal;
}

/// Directions that a certificate must cover: for touched points those about the expected axis or,
/// where the part lies outside that cone, about its least-squares axis; for a points file all
/// directions or, where that takes too long or where another axis contradicts the layers, those
/// about its least-squares axis.
fit::CylinderProofOptions certificate_options(const std::optional<Eigen::Vector3d>& direction,
                                              const fit::LsCylinder& ls,
                                              const FeatureResult& result) {
  const auto cone = [](const Eigen::Vector3d& middle) {
    return fit::AxisScope{fit::AxisScope::Kind::kCone, middle};
  };
  fit::CylinderProofOptions out{.scopes = {cone(ls.axis.direction)}, .search = {}};
  const bool from_file = result.feature.strategy == record::Strategy::kPointsFile;
  if (from_file) {
    out.scopes.insert(out.scopes.begin(), {fit::AxisScope::Kind::kHalfSphere});
    if (direction) out.candidates = cone(ls.axis.direction);
  } else if (direction) {
    out.scopes.insert(out.scopes.begin(), cone(*direction));
  }
  return out;
}

/// The points that take part: all but those in windows.
struct KeptPoints {
  explicit KeptPoints(const std::vector<CloudPoint>& cloud) {
    for (std::size_t row = 0; row < cloud.size(); ++row) {
      if (cloud[row].left_out) continue;
      rows.push_back(row);
      tips_mm.push_back(cloud[row].tip_mm);
    }
  }
  /// Gives contacts the rows of the cloud in place of those among the kept points.
  void name_rows(std::vector<fit::Contact>& contacts) const {
    for (fit::Contact& contact : contacts) contact.index = rows[contact.index];
  }
  /// The same of both sides of a zone, whose contacts the cloud then shows.
  void take_contacts(std::vector<fit::Contact>& outer, std::vector<fit::Contact>& inner,
                     std::vector<CloudPoint>& cloud) const {
    name_rows(outer);
    name_rows(inner);
    for (const fit::Contact& c : outer) cloud[c.index].outer_contact = true;
    for (const fit::Contact& c : inner) cloud[c.index].inner_contact = true;
  }

  std::vector<std::size_t> rows;
  std::vector<Eigen::Vector3d> tips_mm;
};

void evaluate_cylinder(const std::optional<Eigen::Vector3d>& direction, FeatureResult& result) {
  const KeptPoints kept(result.cloud);
  const auto& tips = kept.tips_mm;
  auto ls = fit::ls_cylinder(tips, direction);
  if (!ls) {
    result.failure = ls.error();
    return;
  }
  if (!direction) {
    if (auto one = fit::check_only_cylinder(tips, *ls); !one) {
      result.failure = one.error();
      return;
    }
  }
  const auto proof = certificate_options(direction, *ls, result);
  auto mz = fit::min_zone_cylinder(tips, direction, proof);
  if (!mz) {
    result.failure = mz.error();
    return;
  }
  result.ls_cylinder = *ls;
  result.mz_cylinder = *mz;
  result.mc_cylinder = fit::min_circumscribed_cylinder(tips, ls->axis.direction, proof);
  result.mi_cylinder = fit::max_inscribed_cylinder(tips, ls->axis.direction, proof);
  kept.take_contacts(result.mz_cylinder->outer, result.mz_cylinder->inner, result.cloud);
  for (auto* const fit : {&result.mc_cylinder, &result.mi_cylinder}) {
    if (*fit) kept.name_rows((*fit)->contacts);
  }
  place_points(mz->axis, 0.5 * (mz->inner_radius_mm + mz->outer_radius_mm), mean_of(result.cloud),
               result);
  const bool has_layers = result.feature.layers > 1;
  if (has_layers) result.layers = sections(mz->axis, result.cloud);
}

void evaluate_section(const Eigen::Vector3d& direction, FeatureResult& result) {
  const fit::Axis up{mean_of(result.cloud), direction};
  result.section_axis = up;
  result.layers = sections(up, result.cloud);
  LayerResult& section = result.layers.front();
  if (!section.mz || !section.ls) {
    result.failure = !section.mz ? section.mz.error() : section.ls.error();
    return;
  }
  const fit::MinZoneCircle& zone = *section.mz;
  const auto frame = fit::across(up.direction);
  const fit::Axis axis{up.point_mm + frame * zone.center_mm, up.direction};
  place_points(axis, 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm), up.point_mm, result);
  for (const fit::Contact& c : zone.outer) result.cloud[section.rows[c.index]].outer_contact = true;
  for (const fit::Contact& c : zone.inner) result.cloud[section.rows[c.index]].inner_contact = true;
}

/// A circle; beside one of a file that leans stands the same about z.
void evaluate_circle(const Eigen::Vector3d& direction, FeatureResult& result) {
  const bool from_file = result.feature.strategy == record::Strategy::kPointsFile;
  if (from_file && direction != Eigen::Vector3d::UnitZ()) {
    FeatureResult nominal = result;
    std::erase_if(nominal.feature.settings,
                  [](const record::Setting& setting) { return setting.name == kPlaneSetting; });
    nominal.feature.settings.push_back({kPlaneSetting, {}, "nominal"});
    evaluate_section(Eigen::Vector3d::UnitZ(), nominal);
    result.about_nominal = std::make_shared<const FeatureResult>(std::move(nominal));
  }
  evaluate_section(direction, result);
}

/// Sets angle and distance of every point about the mean point of a plane, and its height above the
/// middle of the zone.
void place_points(const fit::MinZonePlane& zone, const Eigen::Vector3d& mean,
                  std::vector<CloudPoint>& cloud) {
  const auto frame = fit::across(zone.outer.normal);
  for (CloudPoint& point : cloud) {
    const Eigen::Vector2d within = frame.transpose() * (point.tip_mm - mean);
    point.angle_rad = std::atan2(within.y(), within.x());
    if (point.angle_rad < 0.0) point.angle_rad += core::kTwoPi;
    point.height_mm = within.norm();
    point.deviation_mm = fit::height_mm(zone.outer, point.tip_mm) + 0.5 * zone.width_mm;
  }
}

/// @param outward  Side of the material on which the plane was touched; none: not known.
void evaluate_plane(const std::optional<Eigen::Vector3d>& outward, FeatureResult& result) {
  const KeptPoints kept(result.cloud);
  const auto& tips = kept.tips_mm;
  auto ls = fit::ls_plane(tips, outward);
  auto mz = fit::min_zone_plane(tips, outward);
  if (!ls || !mz) {
    result.failure = !ls ? ls.error() : mz.error();
    return;
  }
  place_points(*mz, mean_of(result.cloud), result.cloud);
  kept.take_contacts(mz->top, mz->bottom, result.cloud);
  result.ls_plane = *std::move(ls);
  result.mz_plane = *std::move(mz);
}

/// Sets angle and height of every point about an axis, and its deviation from a surface.
template <class Deviation>
void place_points(const fit::Axis& axis, const Deviation& deviation_mm, FeatureResult& result) {
  place_points(axis, 0.0, mean_of(result.cloud), result);
  for (CloudPoint& point : result.cloud) point.deviation_mm = deviation_mm(point.tip_mm);
}

void evaluate_cone(const std::optional<Eigen::Vector3d>& direction, FeatureResult& result) {
  const KeptPoints kept(result.cloud);
  const auto& tips = kept.tips_mm;
  auto ls = fit::ls_cone(tips, direction);
  auto mz = fit::min_zone_cone(tips, direction);
  if (!ls || !mz) {
    result.failure = !ls ? ls.error() : mz.error();
    return;
  }
  place_points(
      mz->cone.axis, [&](const Eigen::Vector3d& tip_mm) { return mz->cone.deviation_mm(tip_mm); },
      result);
  kept.take_contacts(mz->outer, mz->inner, result.cloud);
  result.ls_cone = *std::move(ls);
  result.mz_cone = *std::move(mz);
}

void evaluate_sphere(FeatureResult& result) {
  const KeptPoints kept(result.cloud);
  const auto& tips = kept.tips_mm;
  auto ls = fit::ls_sphere(tips);
  auto mz = fit::min_zone_sphere(tips);
  if (!ls || !mz) {
    result.failure = !ls ? ls.error() : mz.error();
    return;
  }
  const double middle_mm = 0.5 * (mz->inner_radius_mm + mz->outer_radius_mm);
  place_points(
      fit::Axis{mz->center_mm, Eigen::Vector3d::UnitZ()},
      [&](const Eigen::Vector3d& tip_mm) { return (tip_mm - mz->center_mm).norm() - middle_mm; },
      result);
  kept.take_contacts(mz->outer, mz->inner, result.cloud);
  result.ls_sphere = *std::move(ls);
  result.mz_sphere = *std::move(mz);
}

/// Evaluates the repeats of the final cloud: scatter of a touch, and of the zone of a single cloud.
void evaluate_repeats(const std::vector<const Touch*>& touches,
                      const std::optional<Eigen::Vector3d>& direction, FeatureResult& result) {
  const RepeatNoise noise = repeat_noise(touches, result.cloud);
  if (noise.freedom > 0) {
    result.repeat_sigma_mm = noise.sigma_mm;
    result.repeat_freedom = noise.freedom;
  }
  const auto is_left_out = [](const CloudPoint& point) { return point.left_out; };
  if (std::ranges::any_of(result.cloud, is_left_out)) return;  // zones of all touches mean nothing
  std::map<int, std::vector<Eigen::Vector3d>> clouds;
  std::size_t most = 0;
  for (const Touch* touch : touches) {
    auto& pass = clouds[touch->repeat];
    pass.push_back(touch->tip_mm);
    most = std::max(most, pass.size());
  }
  std::vector<double> zones;
  for (const auto& [repeat, points] : clouds) {
    // An interrupted pass is no cloud; scan passes may differ in their number of points.
    const bool whole = result.cloud.front().pass ? 10 * points.size() > 9 * most
                                                 : points.size() == result.cloud.size();
    if (!whole || !result.mz_cylinder) continue;
    const auto zone = fit::min_zone_cylinder(points, direction);
    if (zone) zones.push_back(zone->width_mm());
  }
  if (zones.size() < 2) return;
  double mean = 0.0;
  for (const double zone : zones) mean += zone / static_cast<double>(zones.size());
  double variance = 0.0;
  for (const double zone : zones)
    variance += std::pow(zone - mean, 2) / static_cast<double>(zones.size() - 1);
  result.repeat_zone_mean_mm = mean;
  result.repeat_zone_sd_mm = std::sqrt(variance);
}

/// The pose that turns the found axis to machine z, from the pose in which it was found.
core::Pose levelling(const fixture::Kinematics& kinematics, const core::Pose& reached,
                     const Eigen::Vector3d& direction_W) {
  Eigen::Vector3d t =
      fixture::body_to_machine(kinematics, reached).linear().transpose() * direction_W;
  if (t.z() < 0.0) t = -t;
  return fixture::levelling_pose(kinematics, t);
}

/// A cylinder measured in several poses: in the body frame, whose z is near its axis.
void evaluate_merged(const RunRecord& record, int index, const std::optional<fit::ProbeTip>& probe,
                     FeatureResult& result) {
  auto cloud = merged_cloud(record, index, probe);
  if (!cloud) {
    result.failure = cloud.error();
    return;
  }
  result.cloud = std::move(cloud->points);
  result.repeat_sigma_mm = cloud->sigma_mm;
  result.temperatures = cloud->temperatures;
  result.merged = std::make_shared<const MergedPoses>(std::move(cloud->merged));
  if (result.merged->refusal) result.warnings.push_back(*result.merged->refusal);
  if (const auto& solved = result.merged->solved; solved && solved->chi2 > solved->chi2_limit) {
    result.warnings.push_back(
        {core::Code::kInconsistent,
         fmt::format(
             "the errors of the poses are larger than the fixture states: chi2 {:.1f}, limit "
             "{:.1f}; calibrate it again or state more",
             solved->chi2, solved->chi2_limit),
         {}});
  }
  evaluate_cylinder(Eigen::Vector3d::UnitZ(), result);
  if (!result.failure) warn(result);
}

/// The first setting of a surface that does not say what a run writes.
std::optional<core::Error> fault_of_settings(const record::Feature& feature) {
  const auto sampling = record::task_of<record::SamplingSettings>(feature.settings);
  if (!sampling) return sampling.error();
  const auto expansion = record::task_of<record::ExpansionSettings>(feature.settings);
  if (!expansion) return expansion.error();
  return std::nullopt;
}

/// A feature before its points are taken: its settings, and the tip that touched it.
FeatureResult begun(const RunRecord& record, int index, const std::optional<fit::ProbeTip>& probe) {
  FeatureResult result;
  result.feature = record.features[static_cast<std::size_t>(index)];
  result.complete = is_complete(record, static_cast<std::size_t>(index));
  if (result.feature.strategy == record::Strategy::kPointsFile) {
    if (result.feature.tip_radius_mm) result.tip_radius_mm = result.feature.tip_radius_mm;
  } else if (probe) {
    result.tip_radius_mm = probe->radius_mm;
  }
  result.failure = fault_of_settings(result.feature);
  return result;
}

/// The touches of the cloud that is evaluated, and where the surface is expected.
struct FinalCloud {
  const record::PoseVisit* visit = nullptr;
  std::vector<const Touch*> touches;
  std::optional<Eigen::Vector3d> direction;  ///< See expected_axis().
};

/// Fills the cloud of a feature, with its temperatures and windows; none where `failure` of the
/// result says why.
std::optional<FinalCloud> take_cloud(const RunRecord& record, int index, FeatureResult& result) {
  const auto last =
      std::find_if(record.poses.begin(), record.poses.end(), [&](const record::PoseVisit& visit) {
        return visit.feature == index && is_final(record, visit);
      });
  if (last == record.poses.end()) {
    result.failure = core::error_of(
        core::Code::kNoPoints,
        record.failure ? core::phrase("not measured to its end: {}", record.failure->said())
                       : core::phrase("the run ended before the final cloud was measured"));
    return std::nullopt;
  }
  FinalCloud out{&*last, touches_of(record, last->id), {}};
  result.cloud = measured_cloud(out.touches);
  if (result.cloud.empty()) {
    result.failure =
        core::error_of(core::Code::kNoPoints, core::phrase("the final cloud holds no touches"));
    return std::nullopt;
  }
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile;
  if (touched) result.part_turn = part_turn(record, *last);
  result.temperatures = temperatures_of(record, touched ? out.touches : decltype(out.touches){});
  result.thermal = thermal_correction(record, index, last->id);
  if (result.thermal && result.tip_radius_mm) {
    const ThermalCorrection& c = *result.thermal;
    *result.tip_radius_mm /= 1.0 + c.part_expansion_1_K * (c.part_degC - 20.0);
  }
  out.direction = expected_axis(record, result, *last);
  if (!touched && result.feature.shape == record::Shape::kCircle)
    result.section_axis.direction = *out.direction;
  for (const LeftOut& row : rows_in_windows(result)) result.cloud[row.row].left_out = true;
  return out;
}

FeatureResult evaluate_feature(const RunRecord& record, int index,
                               const std::optional<fit::ProbeTip>& probe,
                               const fixture::Kinematics& kinematics) {
  FeatureResult result = begun(record, index, probe);
  if (result.failure) return result;
  if (result.feature.strategy == record::Strategy::kMerged) {
    evaluate_merged(record, index, probe, result);
    return result;
  }
  evaluate_poses(record, index, result);
  const auto taken = take_cloud(record, index, result);
  if (!taken) return result;
  const auto& direction = taken->direction;
  switch (result.feature.shape) {
    case record::Shape::kCylinder:
      evaluate_cylinder(direction, result);
      break;
    case record::Shape::kPlane:
      evaluate_plane(direction, result);
      break;
    case record::Shape::kCone:
      evaluate_cone(direction, result);
      break;
    case record::Shape::kSphere:
      evaluate_sphere(result);
      break;
    default:
      evaluate_circle(*direction, result);
  }
  if (result.failure) return result;
  evaluate_repeats(taken->touches, direction, result);
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile;
  if (result.mz_cylinder && touched && !stands_still(result.feature)) {
    result.levelling_pose =
        levelling(kinematics, taken->visit->reached, result.mz_cylinder->axis.direction);
  }
  if (result.feature.strategy == record::Strategy::kVirtual)
    search_virtual_poses(*taken->visit, result);
  warn(result);
  return result;
}

/// The remainder of a feature whose result violated an invariant: the question and the conditions
/// of the measurement. None of its numbers can be trusted.
FeatureResult without_values(const Defect& defect) {
  FeatureResult out;
  out.feature = defect.result.feature;
  out.tip_radius_mm = defect.result.tip_radius_mm;
  out.temperatures = defect.result.temperatures;
  out.thermal = defect.result.thermal;
  out.complete = defect.result.complete;
  out.failure = error_of(defect);
  return out;
}

/// @param intervals  False: only the values are wanted.
CheckedEvaluation evaluate_all(const RunRecord& measured, const InvariantCheck& check,
                               bool intervals) {
  const std::optional<RunRecord> at_20 = compensated(measured);
  const RunRecord& record = at_20 ? *at_20 : measured;
  CheckedEvaluation checked;
  Evaluation& out = checked.evaluation;
  out.rule = rule_of(record);
  out.probe = evaluate_probe(record);
  out.fixture = fixture_facts(record).use;
  // The verdict on a surface may need other features, such as a datum: all are evaluated before one
  // is judged. An analysis is judged at once: a later one may take a value of it, unless it is
  // void.
  const auto evaluating = [&record](std::size_t i) {
    return fmt::format("evaluating {} of {}: {}", i + 1, record.features.size(),
                       record.features[i].id);
  };
  for (std::size_t i = 0; i < record.features.size(); ++i) {
    const core::Working work(evaluating(i));
    const int index = static_cast<int>(i);
    if (record::is_analysis(record.features[i].shape)) {
      // Balls are held against each other as measured, before any surface is brought to 20 degC.
      const bool balls = record.features[i].shape == record::Shape::kRotaryAxes;
      FeatureResult analysed = balls ? evaluate_analysis(measured, index, evaluate_probe(measured))
                                     : evaluate_analysis(record, index, out.probe, out.features);
      decide_analysis(record, out.rule, analysed, intervals);
      if (out.fixture && out.fixture->source == index) {
        hold_against(analysed, taken_calibration(record, index), *out.fixture);
      }
      out.features.push_back(std::move(analysed));
      continue;
    }
    auto feature =
        evaluate_feature(record, index, out.probe, fixture_facts(record, index).kinematics);
    feature.clamping = clamping_of(record, index);
    if (auto broken = check(feature)) {
      checked.defects.push_back({*std::move(broken), std::move(feature)});
      feature = without_values(checked.defects.back());
    }
    out.features.push_back(std::move(feature));
  }
  PartFindings found = find_all(record, out.features, out.probe);
  for (std::size_t i = 0; i < out.features.size(); ++i) {
    FeatureResult& feature = out.features[i];
    if (record::is_analysis(feature.feature.shape)) continue;
    const core::Working work(evaluating(i));
    decide(record, out.rule, out.probe, found[i], feature);
    const bool carried = out.fixture && out.fixture->source < static_cast<int>(i);
    if (carried) apply_calibration(out.fixture, feature);
  }
  out.verdict = overall(out.features);
  return checked;
}

}  // namespace

std::optional<fit::ProbeTip> evaluate_probe(const RunRecord& record) {
  std::vector<Eigen::Vector3d> tips;
  for (const Touch& touch : record.touches) {
    if (touch.purpose == Touch::Purpose::kQualification) tips.push_back(touch.tip_mm);
  }
  if (tips.empty()) return std::nullopt;
  const auto said =
      record::task_of<record::QualificationSettings>(record.settings, "qualification/");
  if (!said) return std::nullopt;
  const auto tip = said->artefact == record::ReferenceArtefact::kColumn
                       ? fit::qualify_tip_on_column(tips, record.artefact.radius_mm)
                       : fit::qualify_tip(tips, record.artefact.radius_mm);
  if (!tip) return std::nullopt;
  return *tip;
}

FeatureResult touched_surface(const RunRecord& record, int index,
                              const std::optional<fit::ProbeTip>& probe) {
  FeatureResult result = begun(record, index, probe);
  if (result.failure) return result;
  const auto taken = take_cloud(record, index, result);
  if (!taken) return result;
  if (result.feature.shape == record::Shape::kCircle)
    result.section_axis = {mean_of(result.cloud), *taken->direction};
  result.clamping = clamping_of(record, index);
  return result;
}

CheckedEvaluation evaluate_checked(const RunRecord& measured, const InvariantCheck& check) {
  CheckedEvaluation out = evaluate_all(measured, check, true);
  const auto values_of = [&](const RunRecord& exact) {
    return evaluate_all(exact, check, false).evaluation;
  };
  hold_against_truth(measured, values_of, out.evaluation);
  return out;
}

FeatureResult evaluate_calibration(const RunRecord& so_far, int index) {
  RunRecord measured = so_far;
  measured.ending = "finished";  // this feature is
  return evaluate_analysis(measured, index, evaluate_probe(measured));
}

core::Result<Evaluation> evaluate(const RunRecord& record) {
  return evaluate_checked(record).evaluation;
}

}  // namespace rondure::evaluation
