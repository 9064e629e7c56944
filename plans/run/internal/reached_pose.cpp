#include "plans/run/internal/reached_pose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/units.h"
#include "fixture/alignment.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr const char* kReachedPosePointer = "/fixture/reached_pose";
constexpr double kLeastLever_mm = 10.0;  ///< At this lever, 1 um of a sphere is 0.006 deg.

/// Largest distance of a sphere from its place in the commanded pose [mm].
double setting_room_mm(const ReachedPosePlan& plan, const fixture::Kinematics& kinematics,
                       const Vector3d& center_B_mm) {
  const double lever_mm = center_B_mm.norm() + (kinematics.axis_offset_mm + center_B_mm).norm();
  return lever_mm * plan.setting_uncertainty_deg * core::kDegree;
}

/// The mean of some points.
Vector3d mean_of(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Lever arm with which the less certain of the two angles moves the spheres [mm].
double least_lever_mm(std::span<const fixture::DirectionPair> pairs, const core::Pose& pose) {
  const Eigen::Matrix3d R = fixture::body_to_machine({}, pose).linear();
  const Vector3d carried(0.0, std::cos(pose.alpha_rad), std::sin(pose.alpha_rad));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  for (const fixture::DirectionPair& pair : pairs) {
    const Vector3d v = R * pair.body;
    Eigen::Matrix<double, 3, 2> J;
    J.col(0) = Vector3d::UnitX().cross(v);
    J.col(1) = carried.cross(v);
    normal += J.transpose() * J;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(normal, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().minCoeff()));
}

/// Checks the pose that was found.
core::Result<void> check_pose(const ReachedPosePlan& plan,
                              std::span<const fixture::DirectionPair> pairs,
                              const core::Pose& found, const core::Pose& asked) {
  const double lever_mm = least_lever_mm(pairs, found);
  if (lever_mm < kLeastLever_mm) {
    return core::fail(core::Code::kRank,
                      fmt::format("in pose {} the spheres on the ring tell one of the angles with "
                                  "a lever of {:.3g} mm, at least {:g} mm are needed; add a sphere "
                                  "off the line of the others",
                                  in_degrees(found), lever_mm, kLeastLever_mm),
                      kReachedPosePointer);
  }
  const Eigen::Matrix3d R = fixture::body_to_machine({}, found).linear();
  double worst_mm = 0.0;
  for (const auto& pair : pairs)
    worst_mm = std::max(worst_mm, (R * pair.body - pair.machine).norm());
  if (worst_mm > plan.residual_limit_um * core::kMicrometre) {
    return core::fail(
        core::Code::kCalibration,
        fmt::format("in pose {} a sphere on the ring is {:.3f} um from where the others put it, "
                    "the limit is {:g} um (residual_limit_um); check their certified centres, that "
                    "none is loose, and that nobody touched the fixture",
                    in_degrees(found), worst_mm / core::kMicrometre, plan.residual_limit_um),
        kReachedPosePointer);
  }
  const double off_rad = std::max(std::abs(found.alpha_rad - asked.alpha_rad),
                                  std::abs(found.beta_rad - asked.beta_rad));
  if (off_rad <= plan.setting_uncertainty_deg * core::kDegree) return {};
  return core::fail(
      core::Code::kMachine,
      fmt::format("the fixture was set to {}, asked for were {}: {:.3g} deg apart, the plan allows "
                  "{:g} deg (setting_uncertainty_deg); set it anew, then resume",
                  in_degrees(found), in_degrees(asked), off_rad / core::kDegree,
                  plan.setting_uncertainty_deg),
      kReachedPosePointer);
}

}  // namespace

core::Result<std::vector<TouchStep>> reached_pose_steps(const Plan& plan,
                                                        const fixture::Kinematics& kinematics,
                                                        int feature, const core::Pose& asked) {
  std::vector<TouchStep> out;
  if (!plan.fixture->reached_pose) return out;
  const ReachedPosePlan& wanted = *plan.fixture->reached_pose;
  const FeaturePlan& of = plan.features[static_cast<std::size_t>(feature)];
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(kinematics, asked);
  const std::size_t of_base = plan.fixture->datum ? plan.fixture->datum->layers() : 0;
  for (std::size_t i = 0; i < wanted.spheres.size(); ++i) {
    const Vector3d center_B = vector3(wanted.spheres[i].center_mm);
    const double off_mm = setting_room_mm(wanted, kinematics, center_B);
    const auto steps =
        sphere_steps(plan, {X_WB * center_B, 0.5 * wanted.sphere_diameter_mm, wanted.points, off_mm,
                            record::Touch::Purpose::kLocate, static_cast<int>(of_base + i)});
    if (!steps) return core::fail(steps.error().at(kReachedPosePointer));
    const std::string name =
        fmt::format("pose {}, sphere {} on the ring", in_degrees(asked), i + 1);
    if (auto clear =
            check_sphere_steps(plan, of, X_WB, wanted.spheres[i].center_mm, off_mm, *steps, name);
        !clear) {
      return core::fail(clear.error().at(kReachedPosePointer));
    }
    out.insert(out.end(), steps->begin(), steps->end());
  }
  return out;
}

core::Result<core::Pose> reached_pose(const Plan& plan, const fixture::Kinematics& kinematics,
                                      std::span<const std::vector<Vector3d>> tips_W_mm,
                                      const core::Pose& asked) {
  const ReachedPosePlan& wanted = *plan.fixture->reached_pose;
  std::vector<Vector3d> nominal_B;
  std::vector<Vector3d> found_F;
  for (std::size_t i = 0; i < tips_W_mm.size(); ++i) {
    const auto center =
        sphere_center(plan, tips_W_mm[i], fmt::format("sphere {} on the ring", i + 1));
    if (!center) return core::fail(center.error().at(kReachedPosePointer));
    nominal_B.push_back(vector3(wanted.spheres[i].center_mm));
    found_F.push_back(kinematics.X_WF.inverse() * *center);
  }
  const Vector3d middle_B = mean_of(nominal_B);
  const Vector3d middle_F = mean_of(found_F);
  std::vector<fixture::DirectionPair> pairs;
  for (std::size_t i = 0; i < nominal_B.size(); ++i) {
    pairs.push_back({nominal_B[i] - middle_B, found_F[i] - middle_F});
  }
  const core::Pose found = fixture::aligning_pose(pairs, asked);
  TRY_DO(check_pose(wanted, pairs, found, asked));
  return on_grid(found);
}

core::Result<core::Pose> measure_reached_pose(RunContext& context,
                                              const std::vector<TouchStep>& steps,
                                              const core::Pose& asked) {
  TRY(const auto tips, touch_spheres(context, steps, [](std::size_t i) {
        return fmt::format("sphere {} on the ring", i + 1);
      }));
  return reached_pose(context.plan, context.cell->kinematics(), tips, asked);
}

}  // namespace rondure::plans
