#include "plans/forecast/forecast.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "fixture/simulated.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/path/internal/cloud_path.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/internal/rotary_poses.h"
#include "plans/run/internal/fixture_base.h"
#include "plans/run/internal/fixture_calibration.h"
#include "plans/run/internal/pose_search.h"
#include "plans/run/internal/qualification.h"
#include "plans/run/internal/reached_pose.h"
#include "plans/run/internal/run_head.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr double kSettle_s = 0.2;  // after each touch, as on the simulated machine

/// Follows the tip and sums touches, lengths and times.
class Tally {
 public:
  Tally(const MachinePlan& machine, Forecast& out)
      : machine_(machine), out_(out), tip_W_mm_(vector3(machine.park_mm)) {}

  void move(ForecastStage& stage, const Polyline& corners_W) {
    for (const Vector3d& corner : corners_W) {
      const double way_mm = (corner - tip_W_mm_).norm();
      stage.path_mm += way_mm;
      stage.time_s += way_mm / machine_.travel_speed_mm_s;
      if (stage.times == 1) stage.moves_W.push_back(corner);
      tip_W_mm_ = corner;
    }
  }
  void rise(ForecastStage& stage) {
    move(stage, {{tip_W_mm_.x(), tip_W_mm_.y(), std::max(tip_W_mm_.z(), machine_.park_mm[2])}});
  }
  void touch(ForecastStage& stage, const Vector3d& contact_W_mm, double approach_mm) {
    stage.path_mm += 2.0 * approach_mm;
    stage.time_s += approach_mm / machine_.touch_speed_mm_s +
                    approach_mm / machine_.travel_speed_mm_s + kSettle_s;
    if (stage.times == 1) {
      stage.contacts_W.push_back(contact_W_mm);
      ++stage.touches;
    }
  }
  /// Adds a whole circle that starts and ends at one contact.
  void scan(ForecastStage& stage, const Vector3d& contact_W_mm, double approach_mm,
            double circle_mm, int points) {
    touch(stage, contact_W_mm, approach_mm);
    stage.path_mm += circle_mm;
    stage.time_s += circle_mm / machine_.scan_speed_mm_s;
    if (stage.times == 1) stage.touches += points - 1;
  }
  void add(ForecastStage stage) { out_.stages.push_back(std::move(stage)); }
  [[nodiscard]] Forecast& forecast() { return out_; }

 private:
  const MachinePlan& machine_;
  Forecast& out_;
  Vector3d tip_W_mm_;
};

fixture::SimulatedFixture ideal_fixture(const Plan& plan) {
  fixture::SimulatedFixtureOptions options;
  options.kinematics = nominal_kinematics(*plan.fixture);
  options.limits = limits_of(*plan.fixture);
  return fixture::SimulatedFixture(options);
}

core::Result<void> add_spheres(const core::Result<std::vector<TouchStep>>& steps,
                               ForecastStage stage, Tally& tally) {
  if (!steps) return core::fail(steps.error());
  if (steps->empty()) return {};
  for (const TouchStep& step : *steps) {
    if (step.row.point == 0) tally.rise(stage);  // from the previous sphere
    tally.move(stage, step.way_W);
    tally.touch(stage, step.command.expected_tip_W_mm, step.command.approach_mm);
  }
  tally.rise(stage);
  tally.add(std::move(stage));
  return {};
}

ForecastStage stage_of(ForecastStage::Kind kind) {
  ForecastStage out;
  out.kind = kind;
  return out;
}

/// Adds the spheres that show the pose set by hand.
core::Result<void> add_ring(const Plan& plan, int feature, const core::Pose& commanded,
                            Tally& tally) {
  ForecastStage stage = stage_of(ForecastStage::Kind::kRing);
  stage.feature = feature;
  stage.pose = commanded;
  return add_spheres(
      reached_pose_steps(plan, nominal_kinematics(*plan.fixture), feature, commanded),
      std::move(stage), tally);
}

/// A feature on the nominal part: the pose search receives ideal touches.
class NominalSession final : public PoseSession {
 public:
  /// @param location_mm  Largest distance of the part from where it is expected.
  NominalSession(const Plan& plan, std::size_t index, Tally& tally, double location_mm)
      : plan_(plan),
        index_(static_cast<int>(index)),
        location_mm_(location_mm),
        feature_(plan.features[index]),
        tally_(tally),
        fixture_(ideal_fixture(plan)),
        planner_(plan, feature_),
        geometry_(path_geometry(plan, feature_, location_mm)) {}

  core::Result<Cloud> measure_reachable(const core::Pose& commanded) override {
    TRY(const auto all, sampling_targets(feature_));
    reachable_ =
        planner_.reachable(all, geometry_, body_at(commanded), nominal_seat(*plan_.fixture));
    if (reachable_.size() < kLeastTargets) {
      return core::fail(core::Code::kUnreachable, too_few_targets(commanded, reachable_.size()));
    }
    return measure(commanded);
  }

  core::Result<Cloud> measure(const core::Pose& commanded) override {
    TRY(const auto targets, measured_targets());
    const std::vector<Target> stops = stops_of(targets);
    TRY_DO(turn(commanded, stops));
    TRY_DO(touch(stops, ForecastStage::Kind::kCloud));
    return Cloud{reached_, tips(targets)};
  }

  core::Result<void> repeat(int times) override {
    if (times < 1) return {};
    TRY(const auto targets, measured_targets());
    TRY(const auto path, lay(stops_of(targets), reached_));
    ForecastStage& stage = tally_.forecast().stages.back();
    for (int i = 0; i < times; ++i) {
      ++stage.times;
      follow(path, stage);
    }
    return {};
  }

  core::Result<void> keep_as_final() override {
    tally_.forecast().stages.back().final_cloud = true;
    return {};
  }

  core::Result<fit::Axis> locate(const core::Pose& commanded) override {
    TRY(const auto targets, locating_targets(feature_, plan_.part.location_uncertainty_mm));
    TRY_DO(turn(commanded, targets));
    TRY_DO(touch(targets, ForecastStage::Kind::kLocation));
    geometry_ = path_geometry(plan_, feature_, 0.0);
    return fit::Axis{part_at(reached_).translation(), expected_axis()};
  }

  /// The touches of a face that show its height.
  core::Result<void> locate_height() {
    TRY(const auto targets, height_targets(feature_));
    TRY_DO(turn({}, targets));
    return touch(targets, ForecastStage::Kind::kLocation);
  }

  [[nodiscard]] bool must_locate() const override { return location_mm_ > 0.0; }
  [[nodiscard]] Vector3d expected_axis() const override {
    return part_at(reached_).linear() * Vector3d::UnitZ();
  }
  [[nodiscard]] core::Pose levelling(const Vector3d& direction_W) const override {
    Vector3d t_B = body_at(reached_).linear().transpose() * direction_W;
    if (t_B.z() < 0.0) t_B = -t_B;
    return fixture::levelling_pose(t_B);
  }
  [[nodiscard]] const fixture::FixtureLimits& limits() const override { return fixture_.limits(); }
  core::Result<void> note(const core::Message&) override { return {}; }
  void show(double) override {}

 private:
  /// All targets, or those that can be reached in one of several poses.
  [[nodiscard]] core::Result<std::vector<Target>> measured_targets() const {
    if (!reachable_.empty()) return reachable_;
    return sampling_targets(feature_);
  }

  [[nodiscard]] bool scans() const {
    return feature_.sampling.method == record::SamplingMethod::kScan;
  }

  /// The places where the tip descends to the surface: every target, or the start of each scanned
  /// layer.
  [[nodiscard]] std::vector<Target> stops_of(const std::vector<Target>& targets) const {
    if (!scans()) return targets;
    std::vector<Target> out;
    for (const Target& target : targets) {
      if (out.empty() || target.layer != out.back().layer) out.push_back(target);
    }
    return out;
  }

  [[nodiscard]] Eigen::Isometry3d body_at(const core::Pose& pose) const {
    return fixture::body_to_machine(nominal_kinematics(*plan_.fixture), pose);
  }
  [[nodiscard]] Eigen::Isometry3d part_at(const core::Pose& pose) const {
    return body_at(pose) * nominal_seat(*plan_.fixture);
  }

  core::Result<CloudPath> lay(const std::vector<Target>& targets, const core::Pose& pose) {
    return planner_.lay(targets, geometry_, body_at(pose), nominal_seat(*plan_.fixture));
  }

  core::Result<void> turn(const core::Pose& commanded, const std::vector<Target>& targets) {
    TRY_DO(lay(targets, commanded));
    TRY(reached_, fixture_.move_to(commanded));
    ++tally_.forecast().poses;
    return add_ring(plan_, index_, commanded, tally_);
  }

  core::Result<void> touch(const std::vector<Target>& targets, ForecastStage::Kind kind) {
    TRY(const auto path, lay(targets, reached_));
    ForecastStage stage;
    stage.kind = kind;
    stage.feature = index_;
    stage.pose = reached_;
    stage.placement = {part_at(reached_), part_at(reached_)};
    follow(path, stage);
    tally_.add(std::move(stage));
    return {};
  }

  void follow(const CloudPath& path, ForecastStage& stage) {
    const Eigen::Isometry3d X_WP = part_at(reached_);
    for (std::size_t k = 0; k < path.order().size(); ++k) {
      tally_.move(stage, path.way_W(k));
      const Vector3d contact_P = contact_tip(geometry_, path.target(k));
      if (scans() && stage.kind == ForecastStage::Kind::kCloud) {
        tally_.scan(stage, X_WP * contact_P, geometry_.approach_mm,
                    core::kTwoPi * contact_P.head<2>().norm(), feature_.sampling.points_per_layer);
        keep_scan(path.target(k), stage);
      } else {
        tally_.touch(stage, X_WP * contact_P, geometry_.approach_mm);
        keep(path.target(k), stage.time_s, stage);
      }
    }
    tally_.move(stage, path.exit_W(path.order().size() - 1));
    tally_.rise(stage);
  }

  void keep(const Target& target, double time_s, ForecastStage& stage) const {
    if (stage.times > 1 || stage.kind != ForecastStage::Kind::kCloud) return;
    stage.measured.push_back({target, part_at(reached_) * contact_tip(geometry_, target), time_s});
  }

  /// Stores the points of a circle that has just ended.
  void keep_scan(const Target& start, ForecastStage& stage) const {
    const auto targets = measured_targets();
    if (!targets) return;  // in that case there would be no path
    const double circle_mm = core::kTwoPi * contact_tip(geometry_, start).head<2>().norm();
    const double circle_s = circle_mm / plan_.machine->scan_speed_mm_s;
    const int points = feature_.sampling.points_per_layer;
    for (const Target& target : *targets) {
      if (target.layer != start.layer) continue;
      keep(target, stage.time_s - circle_s * (1.0 - static_cast<double>(target.point) / points),
           stage);
    }
  }

  [[nodiscard]] std::vector<Vector3d> tips(const std::vector<Target>& targets) const {
    std::vector<Vector3d> out;
    for (const Target& t : targets) out.emplace_back(part_at(reached_) * contact_tip(geometry_, t));
    return out;
  }

  const Plan& plan_;
  int index_;
  double location_mm_;
  const FeaturePlan& feature_;
  Tally& tally_;
  fixture::SimulatedFixture fixture_;
  FeaturePlanner planner_;
  PathGeometry geometry_;
  /// Those reachable in the current one of several poses; otherwise empty.
  std::vector<Target> reachable_;
  core::Pose reached_;
};

/// Adds the poses of a calibration of the fixture, one stage each.
core::Result<void> add_calibration(const Plan& plan, std::size_t feature, Tally& tally) {
  TRY(const auto visits, rotary_visits(plan, feature));
  for (const RotaryVisit& visit : visits) {
    const Eigen::Isometry3d X_WB =
        fixture::body_to_machine(nominal_kinematics(*plan.fixture), visit.pose);
    if (auto added = add_ring(plan, static_cast<int>(feature), visit.pose, tally); !added) {
      return added;
    }
    ForecastStage stage;
    stage.feature = static_cast<int>(feature);
    stage.pose = visit.pose;
    for (const std::size_t ball : visit.balls) {
      TRY(const auto steps, ball_steps(plan, feature, X_WB, ball));
      tally.rise(stage);
      for (const TouchStep& step : steps) {
        tally.move(stage, step.way_W);
        tally.touch(stage, step.command.expected_tip_W_mm, step.command.approach_mm);
      }
    }
    tally.rise(stage);
    tally.add(std::move(stage));
    ++tally.forecast().poses;
  }
  return {};
}

}  // namespace

core::Result<Forecast> forecast(const Plan& plan) {
  Forecast out;
  if (!touches_anything(plan)) return out;
  const Questions before = questions_of_thread();
  Tally tally(*plan.machine, out);
  using Kind = ForecastStage::Kind;
  if (auto added = add_spheres(qualification_steps(plan), stage_of(Kind::kQualification), tally);
      !added) {
    return core::fail(added.error().at("/probe/qualification"));
  }
  TRY_DO(add_spheres(datum_steps(plan), stage_of(Kind::kBase), tally));
  double location_mm = plan.part.location_uncertainty_mm;
  if (const auto& alignment = plan.part.alignment) {
    const std::size_t face = feature_index(plan, alignment->face);
    TRY_DO(NominalSession(plan, face, tally, location_mm).locate_height());
    const std::size_t axis = feature_index(plan, alignment->axis);
    TRY_DO(NominalSession(plan, axis, tally, location_mm).locate({}));
    location_mm = 0.0;
  }
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (measures_by_touch(plan.features[i])) {
      TRY_DO(add_calibration(plan, i, tally));
    }
    if (!is_touched(plan.features[i])) continue;
    NominalSession session(plan, i, tally, location_mm);
    if (auto searched = search_pose(session, plan.features[i]); !searched) {
      return core::fail(searched.error().at(fmt::format("/features/{}", i)));
    }
  }
  for (const ForecastStage& stage : out.stages) {
    out.touches += stage.times * stage.touches;
    out.path_mm += stage.path_mm;
    out.time_s += stage.time_s;
  }
  out.questions = questions_of_thread();
  out.questions.asked -= before.asked;
  out.questions.on_meshes -= before.on_meshes;
  return out;
}

namespace {

record::Touch touch_of(const ForecastTouch& touch, int pose, int repeat) {
  record::Touch out;
  out.pose = pose;
  out.layer = touch.target.layer;
  out.point = touch.target.point;
  out.repeat = repeat;
  out.tip_mm = touch.tip_W_mm;
  out.temperature_degC = out.scale_temperature_degC = 20.0;
  return out;
}

void add_cloud(const ForecastStage& stage, double start_s, record::RunRecord& out) {
  record::PoseVisit pose;
  pose.id = static_cast<int>(out.poses.size());
  pose.feature = stage.feature;
  pose.commanded = pose.reached = stage.pose;
  pose.final_cloud = true;
  pose.time_s = start_s;
  out.poses.push_back(pose);
  for (int repeat = 0; repeat < stage.times; ++repeat) {
    for (const ForecastTouch& measured : stage.measured) {
      record::Touch touch = touch_of(measured, pose.id, repeat);
      touch.id = static_cast<std::int64_t>(out.touches.size());
      touch.time_s = start_s + measured.time_s + repeat * stage.time_s / stage.times;
      out.touches.push_back(touch);
    }
  }
}

void add_qualification(const ForecastStage& stage, record::RunRecord& out) {
  for (const Eigen::Vector3d& tip_mm : stage.contacts_W) {
    record::Touch touch;
    touch.id = static_cast<std::int64_t>(out.touches.size());
    touch.purpose = record::Touch::Purpose::kQualification;
    touch.pose = -1;
    touch.tip_mm = tip_mm;
    touch.temperature_degC = touch.scale_temperature_degC = 20.0;
    out.touches.push_back(touch);
  }
}

}  // namespace

record::RunRecord expected_record(const Plan& plan, const Forecast& forecast) {
  record::RunRecord out = run_head(plan, RunOptions{}, 0);
  double start_s = 0.0;
  for (const ForecastStage& stage : forecast.stages) {
    if (stage.kind == ForecastStage::Kind::kQualification) add_qualification(stage, out);
    if (stage.final_cloud) add_cloud(stage, start_s, out);
    start_s += stage.time_s;
  }
  return out;
}

std::uint64_t forecast_seed(const Plan& plan) {
  return plan.simulation ? plan.simulation->seed + 1 : 0;
}

core::Result<record::RunRecord> with_series(record::RunRecord expected, const Plan& plan,
                                            std::uint64_t seed) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    if (analysis_kind(feature.type) == nullptr || measures_by_touch(feature)) continue;
    TRY(auto data, analysis_data(plan, i, seed));
    if (!has_files(feature)) expected.header.seed = seed;
    for (record::Series& series : data.series) expected.series.push_back(std::move(series));
  }
  return expected;
}

}  // namespace rondure::plans
