#include "plans/path/internal/rotary_poses.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/rotary/ball_setup.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using Eigen::Vector3d;

/// A sphere that stands beside a ball, as far as it may reach.
struct Neighbour {
  Vector3d center_mm;
  double reach_mm = 0.0;
};

/// The spheres on the ring in a pose. None stand on the base: such a plan has no datum.
std::vector<Neighbour> spheres_W(const FixturePlan& fixture, const core::Pose& pose) {
  std::vector<Neighbour> out;
  if (const auto& on_ring = fixture.reached_pose) {
    const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(fixture), pose);
    for (const CarriedSpherePlan& sphere : on_ring->spheres)
      out.push_back({X_WB * vector3(sphere.center_mm), 0.5 * on_ring->sphere_diameter_mm});
  }
  return out;
}

/// Whether the tip can reach a ball, go around it and leave without meeting the sphere `other`.
bool is_free(const Plan& plan, const record::RotaryTask& rotary, const Vector3d& ball,
             const Neighbour& other) {
  const double radius_mm = 0.5 * rotary.ball_diameter_mm;
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  const double around_mm = radius_mm + tip_mm +
                           std::max(plan.machine->approach_mm, plan.machine->clearance_mm) +
                           rotary.uncertainty_mm;
  const double room_mm = around_mm + tip_mm + other.reach_mm;
  const bool above =
      other.center_mm.z() + other.reach_mm + tip_mm + plan.machine->clearance_mm > ball.z();
  return !above || (other.center_mm - ball).head<2>().norm() >= room_mm;
}

std::vector<std::size_t> reachable_balls(const Plan& plan, const record::RotaryTask& rotary,
                                         const std::vector<Vector3d>& centers,
                                         std::vector<Neighbour> others) {
  const std::size_t fixed = others.size();
  for (const Vector3d& center : centers)
    others.push_back({center, 0.5 * rotary.ball_diameter_mm + rotary.uncertainty_mm});
  const double lowest_mm = plan.fixture->rim_height_mm + 0.5 * plan.probe->tip_diameter_mm +
                           plan.machine->clearance_mm + rotary.uncertainty_mm;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    bool free = centers[i].z() >= lowest_mm;
    for (std::size_t k = 0; free && k < others.size(); ++k) {
      free = k == fixed + i || is_free(plan, rotary, centers[i], others[k]);
    }
    if (free) out.push_back(i);
  }
  return out;
}

std::string in_words(const core::Pose& pose) {
  return fmt::format("({:g}, {:g}) deg", pose.alpha_rad / kDegree, pose.beta_rad / kDegree);
}

/// Checks that the balls of a visit determine six errors about an axis.
core::Result<void> check_visit(const record::RotaryTask& rotary,
                               const std::vector<Vector3d>& centers, const RotaryVisit& visit) {
  if (visit.pose == core::Pose{} && visit.balls.size() < rotary.balls.size()) {
    return core::fail_with(core::Code::kUnreachable,
                           "{} of {} balls cannot be reached in the zero pose: every ball must be "
                           "measured there; set them farther apart, or above the rim",
                           rotary.balls.size() - visit.balls.size(), rotary.balls.size());
  }
  std::vector<Vector3d> reached;
  std::vector<std::string> names;
  for (const std::size_t i : visit.balls) {
    reached.push_back(centers[i]);
    names.push_back(rotary.balls[i].id);
  }
  const auto sound = fit::check_setup(reached, names);
  if (sound) return {};
  return core::fail_with(sound.error().code, "in the pose {} {} of {} balls can be reached: {}",
                         in_words(visit.pose), visit.balls.size(), rotary.balls.size(),
                         sound.error().what);
}

/// Stations of an axis in ascending order, without 0.
std::vector<double> stations_rad(std::vector<double> stations_deg) {
  std::sort(stations_deg.begin(), stations_deg.end());
  std::vector<double> out;
  for (const double deg : stations_deg) {
    if (deg != 0.0) out.push_back(deg * kDegree);
  }
  return out;
}

}  // namespace

std::vector<Vector3d> ball_centers_W(const Plan& plan, std::size_t feature,
                                     const core::Pose& pose) {
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), pose);
  std::vector<Vector3d> out;
  for (const record::BallTask& ball : plan.features[feature].rotary_axes->balls) {
    out.emplace_back(X_WB * vector3(ball.center_mm));
  }
  return out;
}

core::Result<std::vector<RotaryVisit>> rotary_visits(const Plan& plan, std::size_t feature) {
  const record::RotaryTask& rotary = *plan.features[feature].rotary_axes;
  std::vector<core::Pose> poses = {{}};
  for (const double beta : stations_rad(rotary.beta_stations_deg)) poses.push_back({0.0, beta});
  poses.emplace_back();
  for (const double alpha : stations_rad(rotary.alpha_stations_deg)) poses.push_back({alpha, 0.0});
  for (const record::CombinedPoseTask& p : rotary.verification) {
    poses.push_back({p.alpha_deg * kDegree, p.beta_deg * kDegree});
  }
  poses.emplace_back();
  std::vector<RotaryVisit> out;
  for (const core::Pose& pose : poses) {
    const auto centers = ball_centers_W(plan, feature, pose);
    RotaryVisit visit{pose, reachable_balls(plan, rotary, centers, spheres_W(*plan.fixture, pose))};
    if (auto sound = check_visit(rotary, centers, visit); !sound) {
      return core::fail(sound.error().at(fmt::format("/features/{}/rotary_axes/balls", feature)));
    }
    out.push_back(std::move(visit));
  }
  return out;
}

}  // namespace rondure::plans
