#include "plans/path/internal/nominal_geometry.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/features.h"

namespace rondure::plans {

fixture::Kinematics nominal_kinematics(const FixturePlan& fixture) {
  return {vector3(fixture.axis_point_mm), vector3(fixture.axis_offset_mm)};
}

Eigen::Isometry3d nominal_seat(const FixturePlan& fixture) {
  Eigen::Isometry3d X_BP = Eigen::Isometry3d::Identity();
  X_BP.translation() = vector3(fixture.part_position_mm);
  return X_BP;
}

fixture::FixtureLimits limits_of(const FixturePlan& fixture) {
  return {fixture.min_alpha_deg * core::kDegree, fixture.max_alpha_deg * core::kDegree,
          fixture.min_beta_deg * core::kDegree, fixture.max_beta_deg * core::kDegree,
          fixture.resolution_deg * core::kDegree};
}

core::Pose start_pose(const FeaturePlan& feature) {
  return {feature.pose_search.start_alpha_deg * core::kDegree,
          feature.pose_search.start_beta_deg * core::kDegree};
}

std::string in_degrees(const core::Pose& pose, int decimals) {
  return fmt::format("({:.{}f}, {:.{}f}) deg", pose.alpha_rad / core::kDegree, decimals,
                     pose.beta_rad / core::kDegree, decimals);
}

std::vector<SectionPlan> part_sections(const Plan& plan, const FeaturePlan& feature) {
  std::vector<SectionPlan> out = plan.part.sections;
  const NominalPlan& mine = feature.nominal;
  for (const FeaturePlan& other : plan.features) {
    const NominalPlan& n = other.nominal;
    const bool beside = n.from_mm >= mine.to_mm || n.to_mm <= mine.from_mm;
    if (!is_touched(other) || other.side == record::Side::kInside ||
        feature.side == record::Side::kInside || !beside)
      continue;
    out.push_back({n.from_mm, n.to_mm, n.diameter_mm, 0.0});
  }
  return out;
}

PathGeometry path_geometry(const Plan& plan, const FeaturePlan& feature, double location_mm) {
  PathGeometry out;
  out.radius_mm = 0.5 * feature.nominal.diameter_mm;
  out.from_mm = feature.nominal.from_mm;
  out.to_mm = feature.nominal.to_mm;
  out.inside = feature.side == record::Side::kInside;
  out.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  out.approach_mm = plan.machine->approach_mm + location_mm;
  out.clearance_mm = plan.machine->clearance_mm + location_mm;
  const auto pass_outside = [&](double diameter_mm, double to_mm) {
    if (to_mm <= feature.nominal.from_mm) return;
    out.to_mm = std::max(out.to_mm, to_mm);
    out.stand_off_mm = std::max(out.stand_off_mm, 0.5 * diameter_mm - out.radius_mm);
  };
  const FixturePlan& fixture = *plan.fixture;
  if (fixture.clamp_from_mm < fixture.clamp_to_mm && fixture.ring_diameter_mm > 0.0) {
    pass_outside(fixture.ring_diameter_mm, fixture.clamp_to_mm);
  }
  for (const SectionPlan& section : part_sections(plan, feature)) {
    out.from_mm = std::min(out.from_mm, section.from_mm);
    pass_outside(section.diameter_mm, section.to_mm);
  }
  return out;
}

core::Result<void> check_clamp(const std::vector<Target>& targets, const PathGeometry& geometry,
                               const FixturePlan& fixture) {
  const bool band = fixture.clamp_from_mm < fixture.clamp_to_mm;
  if (geometry.inside || !band || fixture.ring_diameter_mm > 0.0) return {};
  const double limit_mm = fixture.clamp_to_mm + geometry.clearance_mm + geometry.tip_radius_mm;
  for (const Target& target : targets) {
    if (target.z_mm >= limit_mm) continue;
    return core::fail(
        core::Code::kUnreachable,
        fmt::format(
            "layer {}, point {}: height {:.3f} mm on the part is below {:.3f} mm, where the "
            "clamp, the tip and the clearance end",
            target.layer + 1, target.point + 1, target.z_mm, limit_mm));
  }
  return {};
}

}  // namespace rondure::plans
