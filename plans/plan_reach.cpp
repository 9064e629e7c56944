#include "plans/plan_reach.h"

#include <array>

#include <fmt/format.h>

#include "core/units.h"
#include "fixture/kinematics.h"

namespace rondure::plans {
namespace {

/// The nominal part in the machine frame, in the start pose of a feature.
Eigen::Isometry3d nominal_part(const FixturePlan& fixture, const PoseSearchPlan& search) {
  const core::Pose start{search.start_alpha_deg * core::kDegree,
                         search.start_beta_deg * core::kDegree};
  Eigen::Isometry3d X_WP = fixture::body_to_machine(
      {vector3(fixture.axis_point_mm), vector3(fixture.axis_offset_mm)}, start);
  X_WP.translate(vector3(fixture.part_position_mm));
  return X_WP;
}

}  // namespace

PathGeometry path_geometry(const Plan& plan, const FeaturePlan& feature, double location_mm) {
  PathGeometry out;
  out.radius_mm = 0.5 * feature.nominal.diameter_mm;
  out.from_mm = feature.nominal.from_mm;
  out.to_mm = feature.nominal.to_mm;
  out.inside = feature.side == "inside";
  out.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  out.approach_mm = plan.machine->approach_mm + location_mm;
  out.clearance_mm = plan.machine->clearance_mm + location_mm;
  return out;
}

core::Result<std::vector<Target>> reachable_targets(const Plan& plan, std::size_t index) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = fmt::format("/features/{}/sampling", index);
  auto targets = sampling_targets(feature);
  if (!targets) return core::fail(targets.error().at(where));
  const PathGeometry geometry = path_geometry(plan, feature, plan.part.location_uncertainty_mm);
  if (auto fits = check_fits(geometry); !fits) return core::fail(fits.error().at(where));
  const FixturePlan& fixture = *plan.fixture;
  const Surroundings surroundings{fixture.rim_height_mm, fixture.clamp_from_mm,
                                  fixture.clamp_to_mm};
  const Eigen::Isometry3d X_WP = nominal_part(fixture, feature.pose_search);
  if (auto reach = check_reachable(*targets, geometry, X_WP, surroundings); !reach) {
    return core::fail(reach.error().at(where));
  }
  return targets;
}

}  // namespace rondure::plans
