#include "plans/checks/internal/plan_reach.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/merged_reach.h"
#include "plans/checks/internal/reach_advice.h"
#include "plans/path/internal/feature_planner.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

/// The unreachable targets after the first: "; nor can layer 1 points 2, 3, layer 2 point 1 be
/// reached".
std::string others(const std::vector<Unreachable>& missed) {
  constexpr std::size_t kNamed = 20;
  if (missed.size() < 2) return {};
  std::string out = "; nor can";
  int layer = -1;
  for (std::size_t i = 1; i < std::min(missed.size(), kNamed + 1); ++i) {
    const Target& t = missed[i].target;
    const char* between = i == 1 ? "" : ",";
    if (t.layer != layer) {
      out += fmt::format("{} layer {} point {}", between, t.layer + 1, t.point + 1);
    } else {
      out += fmt::format("{} {}", between, t.point + 1);
    }
    layer = t.layer;
  }
  if (missed.size() > kNamed + 1) out += fmt::format(" and {} more", missed.size() - kNamed - 1);
  return out + " be reached";
}

}  // namespace

core::Result<std::vector<Target>> reachable_targets(const Plan& plan, std::size_t index) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = fmt::format("/features/{}/sampling", index);
  auto targets = sampling_targets(feature);
  if (!targets) return core::fail(targets.error().at(where));
  const PathGeometry geometry = path_geometry(plan, feature, plan.part.location_uncertainty_mm);
  if (auto fits = check_fits(geometry); !fits) return core::fail(fits.error().at(where));
  if (auto clamp = check_clamp(*targets, geometry, *plan.fixture); !clamp) {
    return core::fail(clamp.error().at(where));
  }
  if (feature.pose_search.strategy == record::Strategy::kMerged) {
    TRY_DO(check_merged_reach(plan, index));
    return targets;
  }
  const std::vector<Unreachable> missed = unreachable_targets(plan, feature, start_pose(feature));
  if (missed.empty()) return targets;
  return core::fail(core::Code::kUnreachable,
                    in_words(missed.front()) + others(missed) + "; " + reach_advice(plan, feature),
                    where);
}

core::Result<void> check_room(const Plan& plan) {
  const FixturePlan& fixture = *plan.fixture;
  const QualificationPlan& sphere = plan.probe->qualification;
  // Ball about the base-fixed axis that contains the part in every pose of the fixture.
  double reach_mm = 0.0;
  for (const FeaturePlan& feature : plan.features) {
    if (feature.source) continue;
    if (is_touched(feature) && !SurfaceChart(feature).is_round()) {
      const PartPiece piece = piece_of(feature);
      const double far_mm = std::max(std::abs(piece.from_mm()), std::abs(piece.to_mm()));
      reach_mm = std::max(reach_mm, std::hypot(piece.radius_mm(), far_mm));
      continue;
    }
    const double height =
        std::max(std::abs(feature.nominal.from_mm), std::abs(feature.nominal.to_mm));
    reach_mm = std::max(reach_mm, std::hypot(0.5 * feature.nominal.diameter_mm, height));
    if (!feature.rotary_axes) continue;
    for (const record::BallTask& ball : feature.rotary_axes->balls) {
      reach_mm = std::max(reach_mm, vector3(ball.center_mm).norm() +
                                        0.5 * feature.rotary_axes->ball_diameter_mm +
                                        feature.rotary_axes->uncertainty_mm);
    }
  }
  double top_of_spheres_mm = sphere.sphere_center_mm[2] + 0.5 * sphere.sphere_diameter_mm;
  if (const auto& datum = fixture.datum) {
    for (const DatumSpherePlan& of : datum->spheres) {
      top_of_spheres_mm =
          std::max(top_of_spheres_mm,
                   of.center_mm[2] + 0.5 * datum->sphere_diameter_mm + datum->uncertainty_mm);
    }
  }
  if (const auto& on_ring = fixture.reached_pose) {
    for (const CarriedSpherePlan& of : on_ring->spheres) {
      reach_mm =
          std::max(reach_mm, vector3(of.center_mm).norm() + 0.5 * on_ring->sphere_diameter_mm);
    }
  }
  reach_mm += vector3(fixture.axis_offset_mm).norm() + vector3(fixture.part_position_mm).norm() +
              plan.part.location_uncertainty_mm;
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  const double room_mm = tip_mm + plan.machine->clearance_mm;
  const Eigen::Vector3d axis = vector3(fixture.axis_point_mm);
  const Eigen::Vector3d center = vector3(sphere.sphere_center_mm);
  const double top_mm = std::max(axis.z() + reach_mm, top_of_spheres_mm) + room_mm;
  if (plan.machine->park_mm[2] < top_mm) {
    return core::fail(
        core::Code::kUnreachable,
        fmt::format("park height {:g} mm is below {:.3f} mm, where part or reference sphere, "
                    "tip and clearance end; raise it",
                    plan.machine->park_mm[2], top_mm),
        "/machine/park_mm");
  }
  const double apart_mm = (center - axis).norm();
  const double needed_mm =
      reach_mm + 0.5 * sphere.sphere_diameter_mm + 2.0 * tip_mm + plan.machine->approach_mm;
  if (apart_mm < needed_mm) {
    return core::fail(
        core::Code::kUnreachable,
        fmt::format("the reference sphere stands {:.3f} mm from the fixture's axis, the part "
                    "can sweep it below {:.3f} mm; move it away",
                    apart_mm, needed_mm),
        "/probe/qualification/sphere_center_mm");
  }
  return {};
}

}  // namespace rondure::plans
