#include "evaluation/internal/merged.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/internal/fixture_use.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using record::MergedPosesSettings;
using record::RunRecord;
using record::Touch;

/// Lower bound of the standard uncertainty of a mean touch: the resolution of a machine.
constexpr double kLeastTouch_mm = 0.02e-3;
/// Peak to valley of some 13 normal values, in standard deviations.
constexpr double kFormPerSigma = 3.3;

/// How the fixture moved the part: its nominal axes, with the errors of its calibration.
fixture::Kinematics kinematics_of(const RunRecord& record, int feature,
                                  const MergedPosesSettings& said) {
  fixture::Kinematics out = fixture_facts(record, feature).kinematics;
  out.axis_point_W_mm = Eigen::Vector3d::Map(said.axis_point_mm.data());
  out.axis_offset_mm = Eigen::Vector3d::Map(said.axis_offset_mm.data());
  return out;
}

/// The mean touches of one pose, with their sum of squares along the approach.
struct PoseMeans {
  std::map<std::pair<int, int>, CloudPoint> targets;
  double squares = 0.0;
  int freedom = 0;
};

PoseMeans means_of(const RunRecord& record, int visit) {
  PoseMeans out;
  std::vector<const Touch*> touches;
  for (const Touch& touch : record.touches) {
    if (touch.purpose != Touch::Purpose::kMeasure || touch.pose != visit) continue;
    touches.push_back(&touch);
    auto [found, fresh] = out.targets.try_emplace({touch.layer, touch.point});
    CloudPoint& point = found->second;
    point.layer = touch.layer;
    point.point = touch.point;
    point.repeats = fresh ? 1 : point.repeats + 1;
    point.tip_mm += (touch.tip_mm - point.tip_mm) / point.repeats;
    point.time_s += (touch.time_s - point.time_s) / point.repeats;
  }
  for (const Touch* touch : touches) {
    const Eigen::Vector3d apart =
        touch->tip_mm - out.targets.at({touch->layer, touch->point}).tip_mm;
    out.squares += std::pow(apart.dot(touch->approach), 2);
  }
  out.freedom = static_cast<int>(touches.size()) - static_cast<int>(out.targets.size());
  return out;
}

std::vector<const Touch*> touches_in(const RunRecord& record,
                                     const std::vector<const record::PoseVisit*>& visits) {
  std::vector<const Touch*> out;
  for (const Touch& touch : record.touches) {
    const bool ours = std::any_of(visits.begin(), visits.end(), [&](const auto* visit) {
      return touch.purpose == Touch::Purpose::kMeasure && touch.pose == visit->id;
    });
    if (ours) out.push_back(&touch);
  }
  return out;
}

double touch_uncertainty_mm(const MergedCloud& cloud, const std::optional<fit::ProbeTip>& probe) {
  int repeats = cloud.points.front().repeats;
  for (const CloudPoint& point : cloud.points) repeats = std::min(repeats, point.repeats);
  const double single = cloud.sigma_mm ? *cloud.sigma_mm
                        : probe        ? probe->form_mm / kFormPerSigma
                                       : 0.0;
  return std::max(kLeastTouch_mm, single / std::sqrt(static_cast<double>(repeats)));
}

/// The poses as input of pose_joint(), and the points transformed by the kinematics.
std::vector<fit::JointPose> take_poses(const RunRecord& record, const record::Feature& feature,
                                       const MergedPosesSettings& said,
                                       const std::vector<const record::PoseVisit*>& visits,
                                       MergedCloud& out) {
  const FixtureInfluences stated = fixture_influences(record).value_or(FixtureInfluences{});
  const double shift_mm = stated.position_mm;
  const double turn_rad = stated.angle_rad;
  const fixture::Kinematics kinematics = kinematics_of(record, visits.front()->feature, said);
  std::vector<fit::JointPose> poses;
  double squares = 0.0;
  int freedom = 0;
  for (const record::PoseVisit* visit : visits) {
    const PoseMeans means = means_of(record, visit->id);
    squares += means.squares;
    freedom += means.freedom;
    fit::JointPose pose;
    pose.X_WB = fixture::body_to_machine(kinematics, visit->reached);
    pose.prior = {shift_mm, shift_mm, shift_mm, turn_rad, turn_rad, turn_rad};
    pose.pivot_W_mm = Eigen::Vector3d::Map(said.axis_point_mm.data());
    for (auto [key, point] : means.targets) {
      pose.touches.push_back(
          {point.tip_mm, key.first * std::max(1, feature.points_per_layer) + key.second});
      point.pose = static_cast<int>(poses.size());
      point.tip_mm = pose.X_WB.inverse() * point.tip_mm;
      out.points.push_back(point);
    }
    out.merged.poses.push_back(visit->reached);
    out.merged.frames.push_back(pose.X_WB);
    out.merged.points.push_back(means.targets.size());
    poses.push_back(std::move(pose));
  }
  if (freedom > 0) out.sigma_mm = std::sqrt(squares / freedom);
  return poses;
}

}  // namespace

core::Result<MergedCloud> merged_cloud(const RunRecord& record, int index,
                                       const std::optional<fit::ProbeTip>& probe) {
  const record::Feature& feature = record.features[static_cast<std::size_t>(index)];
  std::vector<const record::PoseVisit*> visits;
  for (const record::PoseVisit& visit : record.poses) {
    if (visit.feature == index && visit.final_cloud) visits.push_back(&visit);
  }
  TRY(const auto said, record::task_of<MergedPosesSettings>(feature.settings));
  const auto planned = static_cast<std::size_t>(said.merged_poses);
  MergedCloud out;
  const std::vector<fit::JointPose> poses = take_poses(record, feature, said, visits, out);
  if (visits.size() != planned || out.points.empty()) {
    return core::fail_with(core::Code::kNoPoints, "{} of {} poses were measured{}", visits.size(),
                           planned, record.failure ? ": " + record.failure->what : std::string());
  }
  out.temperatures = temperatures_of(record, touches_in(record, visits));
  out.merged.joint = said.merge == record::Merge::kJoint;
  out.merged.touch_mm = touch_uncertainty_mm(out, probe);
  if (poses.front().prior[0] == 0.0 && poses.front().prior[3] == 0.0) {
    out.merged.refusal = core::Error{core::Code::kMissingKey,
                                     "the plan does not state the uncertainty of the fixture "
                                     "(uncertainty.fixture), so what it adds to CYLt is not known",
                                     {}};
    if (out.merged.joint) return core::fail(*out.merged.refusal);
    return out;
  }
  fit::PoseJointOptions options;
  options.touch_mm = out.merged.touch_mm;
  auto solved = fit::pose_joint(poses, options);
  if (!solved) {
    if (out.merged.joint) return core::fail(solved.error());
    out.merged.refusal = solved.error();
    return out;
  }
  if (out.merged.joint) {
    for (std::size_t i = 0; i < out.points.size(); ++i)
      out.points[i].tip_mm = solved->joint_B_mm[i];
  }
  out.merged.solved = std::move(*solved);
  return out;
}

}  // namespace rondure::evaluation
