#include "plans/path/internal/nominal_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include <fmt/format.h>

#include "cmm/simulated/part.h"
#include "core/shortest_turn.h"
#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/path/solid_mesh.h"

namespace rondure::plans {
namespace {

constexpr double kDisc_mm = 1.0;  // thickness of the disc behind a plane

}  // namespace

fixture::Kinematics nominal_kinematics(const FixturePlan& fixture) {
  return {vector3(fixture.axis_point_mm), vector3(fixture.axis_offset_mm)};
}

double seat_width_mm(const DatumPlan& datum) {
  constexpr int kDirections = 180;
  double least_mm = datum.seat.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (int k = 0; k < kDirections; ++k) {
    const double angle_rad = 0.5 * core::kTwoPi * k / kDirections;
    const auto along = [&](const DatumSeatPlan& at) {
      return std::cos(angle_rad) * at.point_mm[0] + std::sin(angle_rad) * at.point_mm[1];
    };
    const auto [low, high] = std::ranges::minmax(datum.seat | std::views::transform(along));
    least_mm = std::min(least_mm, high - low);
  }
  return least_mm;
}

double most_lean_rad(const DatumPlan& datum) {
  return datum.on_holes() ? 2.0 * datum.uncertainty_mm / seat_width_mm(datum) : 0.0;
}

Eigen::Isometry3d nominal_seat(const FixturePlan& fixture) {
  Eigen::Isometry3d X_BP = Eigen::Isometry3d::Identity();
  X_BP.translation() = vector3(fixture.part_position_mm);
  X_BP.linear() = core::shortest_turn(Eigen::Vector3d::UnitZ(), vector3(fixture.part_axis));
  return X_BP;
}

Eigen::Isometry3d placed_body(const BodyPlan& body) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = vector3(body.position_mm);
  const Eigen::Vector3d turn_rad = vector3(body.rotation_deg) * core::kDegree;
  out.rotate(Eigen::AngleAxisd(turn_rad.z(), Eigen::Vector3d::UnitZ()));
  out.rotate(Eigen::AngleAxisd(turn_rad.y(), Eigen::Vector3d::UnitY()));
  out.rotate(Eigen::AngleAxisd(turn_rad.x(), Eigen::Vector3d::UnitX()));
  return out;
}

std::vector<Eigen::Vector3d> corners_of(const BodyPlan& body) {
  std::vector<Eigen::Vector3d> out;
  if (body.mesh) {
    out = body.mesh->points_mm();
  } else {
    constexpr int kSides = 16;
    const double corner_mm = 0.5 * body.diameter_mm / std::cos(core::kTwoPi / (2 * kSides));
    for (int k = 0; k < kSides; ++k) {
      const double theta_rad = core::kTwoPi * k / kSides;
      for (const double z : {body.from_mm, body.to_mm})
        out.emplace_back(corner_mm * std::cos(theta_rad), corner_mm * std::sin(theta_rad), z);
    }
  }
  const Eigen::Isometry3d in_frame = placed_body(body);
  for (Eigen::Vector3d& corner : out) corner = in_frame * corner;
  return out;
}

Eigen::Isometry3d standing_part(const FixturePlan& fixture) {
  return fixture::body_to_machine(nominal_kinematics(fixture), {}) * nominal_seat(fixture);
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

double PartPiece::from_mm() const {
  return origin_mm.z() + (solid.ball ? -solid.outer_mm : solid.from_mm);
}

double PartPiece::to_mm() const {
  return origin_mm.z() + (solid.ball ? solid.outer_mm : solid.to_mm);
}

double PartPiece::radius_mm() const { return origin_mm.head<2>().norm() + solid.widest_mm(); }

PartPiece piece_of(const FeaturePlan& feature) {
  const NominalPlan& n = feature.nominal;
  const double radius_mm = 0.5 * n.diameter_mm;
  switch (feature.type) {
    case record::Shape::kPlane: {
      const double behind_mm = n.faces != record::Faces::kDown ? -kDisc_mm : kDisc_mm;
      return {Eigen::Vector3d::Zero(),
              {0.5 * n.from_diameter_mm, 0.5 * n.to_diameter_mm,
               std::min(n.z_mm, n.z_mm + behind_mm), std::max(n.z_mm, n.z_mm + behind_mm)}};
    }
    case record::Shape::kSphere:
      return {vector3(n.center_mm), {0.0, radius_mm, 0.0, 0.0, true, 0.0, true}};
    case record::Shape::kCone:
      return {Eigen::Vector3d::Zero(),
              {0.0, radius_mm, n.from_mm, n.to_mm, false,
               (n.to_mm - n.from_mm) * std::tan(n.half_angle_deg * core::kDegree), true}};
    default:
      break;
  }
  const bool bore = feature.side == record::Side::kInside;
  return {Eigen::Vector3d::Zero(),
          {bore ? radius_mm : 0.0, bore ? radius_mm + cmm::kBlockWall_mm : radius_mm, n.from_mm,
           n.to_mm}};
}

std::vector<PartPiece> part_beside(const Plan& plan, const FeaturePlan& feature) {
  std::vector<PartPiece> out;
  for (const SectionPlan& s : plan.part.sections) {
    out.push_back({Eigen::Vector3d::Zero(),
                   {0.5 * s.bore_diameter_mm, 0.5 * s.diameter_mm, s.from_mm, s.to_mm}});
  }
  if (feature.side == record::Side::kInside) return out;
  const auto along_axis = [](const FeaturePlan& f) {
    return f.type == record::Shape::kCylinder || f.type == record::Shape::kCircle;
  };
  const NominalPlan& mine = feature.nominal;
  for (const FeaturePlan& other : plan.features) {
    if (&other == &feature || other.id == feature.id || !is_touched(other) ||
        other.side == record::Side::kInside)
      continue;
    const NominalPlan& n = other.nominal;
    // One cylinder may be two features: what lies beside itself is no neighbour.
    const bool beside = n.from_mm >= mine.to_mm || n.to_mm <= mine.from_mm;
    if (along_axis(feature) && along_axis(other) && !beside) continue;
    out.push_back(piece_of(other));
  }
  return out;
}

PathGeometry path_geometry(const Plan& plan, const FeaturePlan& feature, double location_mm) {
  PathGeometry out;
  out.radius_mm = 0.5 * feature.nominal.diameter_mm;
  out.from_mm = feature.nominal.from_mm;
  out.to_mm = feature.nominal.to_mm;
  out.surface = SurfaceChart(feature);
  if (!out.surface->is_round()) {
    const PartPiece own = piece_of(feature);
    out.radius_mm = own.radius_mm();
    out.from_mm = own.from_mm();
    out.to_mm = own.to_mm();
  }
  const double lower_end_mm = out.from_mm;
  out.inside = feature.side == record::Side::kInside;
  out.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  out.approach_mm = plan.machine->approach_mm + location_mm;
  out.clearance_mm = plan.machine->clearance_mm + location_mm;
  out.location_mm = location_mm;
  const auto pass_outside = [&](double radius_mm, double to_mm) {
    if (to_mm <= lower_end_mm) return;
    out.to_mm = std::max(out.to_mm, to_mm);
    out.stand_off_mm = std::max(out.stand_off_mm, radius_mm - out.radius_mm);
  };
  const FixturePlan& fixture = *plan.fixture;
  if (fixture.clamp_from_mm < fixture.clamp_to_mm && fixture.ring_diameter_mm > 0.0) {
    pass_outside(0.5 * fixture.ring_diameter_mm, fixture.clamp_to_mm);
  }
  for (const PartPiece& piece : part_beside(plan, feature)) {
    out.from_mm = std::min(out.from_mm, piece.from_mm());
    pass_outside(piece.radius_mm(), piece.to_mm());
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
    return core::fail_with(core::Code::kUnreachable,
                           "layer {}, point {}: height {:.3f} mm on the part is below {:.3f} mm, "
                           "where the clamp, the tip and the clearance end",
                           target.layer + 1, target.point + 1, target.z_mm, limit_mm);
  }
  return {};
}

}  // namespace rondure::plans
