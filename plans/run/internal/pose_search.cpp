#include "plans/run/internal/pose_search.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "core/units.h"
#include "fit/poses/walk.h"
#include "fit/references/min_zone.h"
#include "fit/zone/center_search.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

using record::Strategy;

/// Finer than any fixture resolves: at 35 mm this angle moves a point by 1 nm.
constexpr double kFinestStep = 2e-6 * core::kDegree;

core::Pose start_pose(const PoseSession& session, const FeaturePlan& feature) {
  return session.commanded_for(start_pose(feature));
}

bool within(const fixture::FixtureLimits& limits, const core::Pose& pose) {
  return pose.alpha_rad >= limits.min_alpha_rad && pose.alpha_rad <= limits.max_alpha_rad &&
         pose.beta_rad >= limits.min_beta_rad && pose.beta_rad <= limits.max_beta_rad;
}

double f_of(const Cloud& cloud, bool as_published) {
  std::vector<Eigen::Vector2d> section;
  section.reserve(cloud.tips_W_mm.size());
  for (const Eigen::Vector3d& tip : cloud.tips_W_mm) section.emplace_back(tip.head<2>());
  const auto search =
      as_published ? fit::center_search_as_published(section) : fit::center_search(section);
  return search ? search->width_mm() : std::numeric_limits<double>::infinity();
}

core::Result<void> finish(PoseSession& session, const FeaturePlan& feature) {
  if (auto kept = session.keep_as_final(); !kept) return kept;
  return session.repeat(feature.pose_search.repeats - 1);
}

/// The decision of the guided search after a cloud.
struct NextStep {
  core::MessageCode code = core::MessageCode::kLevellingStep;  ///< Any other code ends the search.
  core::Pose pose;                                             ///< The pose to step to.
  double size_rad = 0.0;  ///< Largest angle from the current pose to it.
};

double in_deg(double angle_rad) { return angle_rad / core::kDegree; }

/// A decision about a pose.
core::Message message_at(const core::Pose& pose, core::MessageCode code,
                         std::initializer_list<core::Argument> others) {
  core::Message out{code, {in_deg(pose.alpha_rad), in_deg(pose.beta_rad)}};
  out.arguments.insert(out.arguments.end(), others);
  return out;
}

/// The message for the next step.
/// @param zone_um  Zone of the cloud in the pose `reached`, the `visit`-th of the search.
core::Message message_of(const NextStep& next, const core::Pose& reached, double zone_um, int visit,
                         const fixture::FixtureLimits& limits) {
  const double step_deg = in_deg(next.size_rad);
  switch (next.code) {
    case core::MessageCode::kLevelToResolution:
      return message_at(reached, next.code, {zone_um, step_deg, in_deg(limits.resolution_rad)});
    case core::MessageCode::kLevelToScatter:
      return message_at(reached, next.code, {zone_um, step_deg});
    case core::MessageCode::kNotLevelAfterPoses:
      return message_at(reached, next.code, {zone_um, static_cast<double>(visit), step_deg});
    default:  // a step to a pose, or one that the fixture does not reach
      return message_at(reached, next.code,
                        {zone_um, in_deg(next.pose.alpha_rad), in_deg(next.pose.beta_rad)});
  }
}

NextStep next_step(const PoseSession& session, const Cloud& cloud,
                   const Eigen::Vector3d& direction_W, double last_rad) {
  NextStep out;
  out.pose = session.levelling(direction_W);
  out.size_rad = std::max(std::abs(out.pose.alpha_rad - cloud.reached.alpha_rad),
                          std::abs(out.pose.beta_rad - cloud.reached.beta_rad));
  const double finest = std::max(0.5 * session.limits().resolution_rad, kFinestStep);
  if (out.size_rad <= finest * (1.0 + 1e-9)) {
    out.code = core::MessageCode::kLevelToResolution;
  } else if (!within(session.limits(), out.pose)) {
    out.code = core::MessageCode::kLevelPoseBeyondLimits;
  } else if (out.size_rad >= 0.5 * last_rad) {
    out.code = core::MessageCode::kLevelToScatter;
  }
  return out;
}

/// Fits a cylinder to each cloud and goes to the pose it predicts, until the fixture cannot
/// improve it.
///
/// @param pose  First pose: where the located part should be level.
core::Result<void> guided(PoseSession& session, const FeaturePlan& feature, core::Pose pose) {
  double last_rad = std::numeric_limits<double>::infinity();
  for (int visit = 1;; ++visit) {
    const auto cloud = session.measure(pose);
    if (!cloud) {
      // The plan demands the start pose; any other pose is optional.
      const bool wanted = visit > 1 || !(pose == start_pose(session, feature));
      if (!wanted || cloud.error().code != core::Code::kUnreachable)
        return core::fail(cloud.error());
      auto noted = session.note({core::MessageCode::kLevelPoseUnreachable, {cloud.error().what}});
      if (!noted) return noted;
      if (visit > 1) break;
      pose = start_pose(session, feature);
      continue;
    }
    session.show(f_of(*cloud, false));
    TRY(const auto zone, fit::min_zone_cylinder(cloud->tips_W_mm, session.expected_axis()));
    NextStep next = next_step(session, *cloud, zone.axis.direction, last_rad);
    const bool steps = next.code == core::MessageCode::kLevellingStep;
    const bool last = !steps || visit == feature.pose_search.max_poses;
    if (steps && last) next.code = core::MessageCode::kNotLevelAfterPoses;
    auto noted = session.note(message_of(next, cloud->reached, zone.width_mm() / core::kMicrometre,
                                         visit, session.limits()));
    if (!noted) return noted;
    if (last) break;
    pose = next.pose;
    last_rad = next.size_rad;
  }
  return finish(session, feature);
}

/// Searches the published grid; then measures the best pose again.
core::Result<void> grid(PoseSession& session, const FeaturePlan& feature) {
  const auto f = [&](const core::Pose& pose) -> core::Result<double> {
    const auto cloud = session.measure(pose);
    if (!cloud) {
      // A pose that cannot be measured is skipped, like one beyond the limits.
      const bool unreachable = cloud.error().code == core::Code::kUnreachable;
      return core::fail(unreachable ? core::Code::kPoseRange : cloud.error().code,
                        cloud.error().what);
    }
    const double value = f_of(*cloud, true);
    session.show(value);
    return value;
  };
  TRY(const auto walk,
      fit::walk_poses(f, start_pose(session, feature), feature.pose_search.steps_deg));
  const fit::PoseStep& best = walk.visited[walk.best];
  auto noted = session.note(
      message_at(best.pose, core::MessageCode::kPoseSearchEnded,
                 {static_cast<double>(walk.visited.size()), best.f_mm / core::kMicrometre}));
  if (!noted) return noted;
  TRY_DO(session.measure(best.pose));
  return finish(session, feature);
}

/// A surface about the part axis: its section shows f, and a few touches locate the part.
bool is_round(record::Shape shape) {
  return shape == record::Shape::kCylinder || shape == record::Shape::kCircle;
}

/// Whether the part can be turned: f is of the pose, and without a fixture there is none.
bool turns(const PoseSession& session) {
  return session.limits().min_alpha_rad < session.limits().max_alpha_rad;
}

/// Measures one cloud in the start pose: no search, or a cloud that is later turned in software.
core::Result<void> single(PoseSession& session, const FeaturePlan& feature) {
  TRY(const auto cloud, session.measure(start_pose(session, feature)));
  if (is_round(feature.type) && turns(session)) session.show(f_of(cloud, false));
  return finish(session, feature);
}

/// Measures the reachable targets in each of the plan's poses, with its repeats; together they are
/// one cloud.
core::Result<void> merged(PoseSession& session, const FeaturePlan& feature) {
  const int targets = feature.sampling.layers * feature.sampling.points_per_layer;
  for (const MeasuringPosePlan& at : feature.pose_search.poses) {
    const core::Pose pose{at.alpha_deg * core::kDegree, at.beta_deg * core::kDegree};
    TRY(const auto cloud, session.measure_reachable(pose));
    session.show(f_of(cloud, false));
    auto noted = session.note(
        message_at(pose, core::MessageCode::kTargetsReachable,
                   {static_cast<double>(cloud.tips_W_mm.size()), static_cast<double>(targets)}));
    if (!noted) return noted;
    if (auto done = finish(session, feature); !done) return done;
  }
  return {};
}

}  // namespace

core::Result<void> search_pose(PoseSession& session, const FeaturePlan& feature) {
  const Strategy strategy = feature.pose_search.strategy;
  core::Pose pose = start_pose(session, feature);
  // A part that needs several poses shows too little in one of them to be located; a plane, cone or
  // sphere shows no place of the part alone. Their approach is longer instead.
  if (session.must_locate() && strategy != Strategy::kMerged && is_round(feature.type)) {
    TRY(const auto axis, session.locate(pose));
    if (!turns(session)) return single(session, feature);
    const core::Pose level = session.levelling(axis.direction);
    auto noted = session.note(message_at(pose, core::MessageCode::kPartLocated,
                                         {in_deg(level.alpha_rad), in_deg(level.beta_rad)}));
    if (!noted) return noted;
    // The other strategies start in the pose of the plan: they serve to compare it.
    const bool guides = feature.type == record::Shape::kCylinder && strategy == Strategy::kGuided;
    if (guides && within(session.limits(), level)) pose = level;
  }
  if (feature.type != record::Shape::kCylinder) return single(session, feature);
  switch (strategy) {
    case Strategy::kStartPose:
    case Strategy::kVirtual:
      return single(session, feature);
    case Strategy::kMerged:
      return merged(session, feature);
    case Strategy::kGuided:
      return guided(session, feature, pose);
    case Strategy::kAsPublished:
      return grid(session, feature);
    case Strategy::kPointsFile:
    case Strategy::kSeries:
    case Strategy::kStations:
      break;
  }
  return core::fail_with(core::Code::kMeaning, "no pose is searched by the strategy {}",
                         record::name_of(strategy));
}

}  // namespace rondure::plans
