#include "plans/checks/internal/plan_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/reach_advice.h"
#include "plans/path/internal/cloud_path.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/sampling.h"

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

/// Checks that the tip parks above everything.
core::Result<void> check_park(const Plan& plan, double highest_mm) {
  const double top_mm =
      highest_mm + (0.5 * plan.probe->tip_diameter_mm + plan.machine->clearance_mm);
  if (plan.machine->park_mm[2] >= top_mm) return {};
  return core::fail(
      core::Code::kUnreachable,
      fmt::format("park height {:g} mm is below {:.3f} mm, where all that stands there, "
                  "tip and clearance end; raise it",
                  plan.machine->park_mm[2], top_mm),
      "/machine/park_mm");
}

/// Centres of balls of its radius, and 1 mm more for a column, that together contain what the probe
/// is qualified on.
std::vector<Eigen::Vector3d> places_of_artefact(const Plan& plan) {
  constexpr double kStep_mm = 2.0;
  const QualificationPlan& q = plan.probe->qualification;
  const Eigen::Vector3d place = vector3(q.place_mm());
  if (!q.on_column()) return {place};
  std::vector<Eigen::Vector3d> out;
  const double foot_mm = std::min(plan.fixture->table_height_mm - place.z(), q.column_from_mm);
  for (double height_mm = q.column_to_mm; height_mm > foot_mm - kStep_mm; height_mm -= kStep_mm) {
    out.emplace_back(place + height_mm * Eigen::Vector3d::UnitZ());
  }
  return out;
}

double radius_of_artefact(const QualificationPlan& q) {
  return 0.5 * q.diameter_mm() + (q.on_column() ? 1.0 : 0.0);
}

std::string pointer_of_artefact(const QualificationPlan& q) {
  return fmt::format("/probe/qualification/{}",
                     q.on_column() ? "column_point_mm" : "sphere_center_mm");
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

core::Result<void> check_room_at(const Plan& plan, const Eigen::Isometry3d& X_WP) {
  const QualificationPlan& q = plan.probe->qualification;
  const double radius_mm = radius_of_artefact(q);
  std::vector<Eigen::Vector3d> places = places_of_artefact(plan);
  for (Eigen::Vector3d& place : places) place = X_WP.inverse() * place;
  const double up = X_WP.linear()(2, 2);
  double highest_mm = q.place_mm()[2] + q.top_mm();
  double apart_mm = std::numeric_limits<double>::infinity();
  const auto add = [&](double from_mm, double to_mm, double outer_mm) {
    const double top_mm = std::max(up * from_mm, up * to_mm) +
                          outer_mm * std::sqrt(std::max(0.0, 1.0 - up * up)) +
                          plan.part.location_uncertainty_mm;
    highest_mm = std::max(highest_mm, X_WP.translation().z() + top_mm);
    for (const Eigen::Vector3d& place : places) {
      const double along_mm = std::max({0.0, from_mm - place.z(), place.z() - to_mm});
      const double beside_mm = std::max(0.0, place.head<2>().norm() - outer_mm);
      apart_mm = std::min(apart_mm, std::hypot(along_mm, beside_mm));
    }
  };
  for (const FeaturePlan& feature : plan.features) {
    if (!is_touched(feature)) continue;
    const PartPiece piece = piece_of(feature);
    add(piece.from_mm(), piece.to_mm(), piece.radius_mm());
  }
  for (const SectionPlan& s : plan.part.sections) add(s.from_mm, s.to_mm, 0.5 * s.diameter_mm);
  for (const BodyPlan& body : plan.fixture->bodies) {
    const bool on_part = body.frame == BodyPlan::Frame::kPart;
    for (const Eigen::Vector3d& corner : corners_of(body))
      highest_mm = std::max(highest_mm, on_part ? (X_WP * corner).z() : corner.z());
  }
  if (const auto& held = plan.part.held) add(held->from_mm, held->to_mm, 0.5 * held->diameter_mm);
  TRY_DO(check_park(plan, highest_mm));
  const double needed_mm = radius_mm + plan.probe->tip_diameter_mm + plan.machine->approach_mm +
                           plan.machine->clearance_mm + plan.part.location_uncertainty_mm;
  if (apart_mm >= needed_mm) return {};
  return core::fail(core::Code::kUnreachable,
                    fmt::format("the centre of the {} is {:.3f} mm from the part or what holds it, "
                                "{:.3f} mm are needed; move it away",
                                q.name(), apart_mm, needed_mm),
                    pointer_of_artefact(q));
}

core::Result<void> check_room(const Plan& plan) {
  const FixturePlan& fixture = *plan.fixture;
  if (is_fixed(plan)) return check_room_at(plan, standing_part(fixture));
  const QualificationPlan& q = plan.probe->qualification;
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
  double highest_mm = q.place_mm()[2] + q.top_mm();
  // A sphere, dowel or bolt head of the base, at its place that is nearest to the axis.
  struct Standing {
    std::string pointer;
    Eigen::Vector3d place_mm;
    double reach_mm;
  };
  std::vector<Standing> standing;
  const Eigen::Vector3d axis = vector3(fixture.axis_point_mm);
  if (const auto& datum = fixture.datum) {
    for (std::size_t i = 0; i < datum->spheres.size(); ++i) {
      const Eigen::Vector3d center = vector3(datum->spheres[i].center_mm);
      const double mine_mm = 0.5 * datum->sphere_diameter_mm + datum->uncertainty_mm;
      highest_mm = std::max(highest_mm, center.z() + mine_mm);
      standing.push_back({fmt::format("/fixture/datum/spheres/{}", i), center, mine_mm});
    }
    for (const DatumSeatPlan& of : datum->seat)
      highest_mm = std::max(highest_mm, of.point_mm[2] + datum->uncertainty_mm);
    for (std::size_t i = 0; i < datum->holes.size(); ++i) {
      const DatumHolePlan& of = datum->holes[i];
      const bool out = of.side == record::Side::kOutside;
      Eigen::Vector3d top = vector3(of.center_mm);
      if (out) top.z() += of.depth_mm;
      highest_mm = std::max(highest_mm, top.z() + datum->uncertainty_mm);
      top.z() = std::min(top.z(), axis.z());
      const double mine_mm = 0.5 * of.diameter_mm + datum->uncertainty_mm;
      if (out) standing.push_back({fmt::format("/fixture/datum/holes/{}", i), top, mine_mm});
    }
  }
  if (const auto& on_ring = fixture.reached_pose) {
    for (const CarriedSpherePlan& of : on_ring->spheres) {
      reach_mm =
          std::max(reach_mm, vector3(of.center_mm).norm() + 0.5 * on_ring->sphere_diameter_mm);
    }
  }
  for (const BodyPlan& body : fixture.bodies) {
    for (const Eigen::Vector3d& corner : corners_of(body)) {
      if (body.frame == BodyPlan::Frame::kBase) {
        highest_mm = std::max(highest_mm, corner.z());
      } else {
        reach_mm = std::max(reach_mm, corner.norm());
      }
    }
  }
  reach_mm += vector3(fixture.axis_offset_mm).norm() + vector3(fixture.part_position_mm).norm() +
              plan.part.location_uncertainty_mm;
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  TRY_DO(check_park(plan, std::max(axis.z() + reach_mm, highest_mm)));
  double apart_mm = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place : places_of_artefact(plan))
    apart_mm = std::min(apart_mm, (place - axis).norm());
  const double needed_mm =
      reach_mm + radius_of_artefact(q) + 2.0 * tip_mm + plan.machine->approach_mm;
  if (apart_mm < needed_mm) {
    return core::fail(
        core::Code::kUnreachable,
        fmt::format("the {} stands {:.3f} mm from the fixture's axis, the part can sweep it below "
                    "{:.3f} mm; move it away",
                    q.name(), apart_mm, needed_mm),
        pointer_of_artefact(q));
  }
  for (const Standing& of : standing) {
    const double off_mm = (of.place_mm - axis).norm();
    if (off_mm >= reach_mm + of.reach_mm) continue;
    return core::fail(
        core::Code::kUnreachable,
        fmt::format("it stands {:.3f} mm from the fixture's axis, the part can sweep it below "
                    "{:.3f} mm; move it away",
                    off_mm, reach_mm + of.reach_mm),
        of.pointer);
  }
  return {};
}

std::string too_few_targets(const core::Pose& pose, std::size_t reached) {
  return fmt::format("pose ({:g}, {:g}) deg: {} targets can be reached, at least {} are needed",
                     pose.alpha_rad / core::kDegree, pose.beta_rad / core::kDegree, reached,
                     kLeastTargets);
}

core::Result<void> check_merged_reach(const Plan& plan, std::size_t index) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = fmt::format("/features/{}", index);
  const auto targets = sampling_targets(feature);
  if (!targets) return core::fail(targets.error().at(where + "/sampling"));
  std::vector<Unreachable> never;  // unreachable in every pose so far, with the last reason
  for (std::size_t k = 0; k < feature.pose_search.poses.size(); ++k) {
    const MeasuringPosePlan& at = feature.pose_search.poses[k];
    const core::Pose pose{at.alpha_deg * core::kDegree, at.beta_deg * core::kDegree};
    std::vector<Unreachable> missed = unreachable_targets(plan, feature, pose);
    if (targets->size() - missed.size() < kLeastTargets) {
      return core::fail(core::Code::kUnreachable,
                        too_few_targets(pose, targets->size() - missed.size()),
                        fmt::format("{}/pose_search/poses/{}", where, k));
    }
    if (k > 0) {
      std::erase_if(missed, [&](const Unreachable& now) {
        return std::none_of(never.begin(), never.end(),
                            [&](const Unreachable& before) { return before.target == now.target; });
      });
    }
    never = std::move(missed);
  }
  if (never.empty()) return {};
  return core::fail(core::Code::kUnreachable,
                    fmt::format("{} of {} targets can be reached in none of the poses; the first: "
                                "{}; add a pose, or keep the layers off the clamp",
                                never.size(), targets->size(), in_words(never.front())),
                    where + "/pose_search/poses");
}

}  // namespace rondure::plans
