#include "plans/path/scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr double kWide_mm = 1e5;      // radius of a disc that cannot be bypassed
constexpr double kDeep_mm = 1e4;      // thickness of a body that cannot be passed below
constexpr double kHolder_mm = 300.0;  // length of the holder above the stylus
/// Paths along a part are laid at exactly the distances to keep, and the corners of its facets lie
/// in its walls: a mesh of it may be nearer by so much.
constexpr double kAlongPart_mm = 0.05;

Tool tool_of(const Plan& plan) {
  const ProbePlan& probe = *plan.probe;
  return {0.5 * probe.tip_diameter_mm, probe.stylus_length_mm, 0.5 * probe.stylus_diameter_mm,
          0.5 * probe.holder_diameter_mm};
}

const char* name_of(Body body) {
  switch (body) {
    case Body::kFeature:
    case Body::kSection:
      return "the part";
    case Body::kShoulder:
      return "a shoulder of the part";
    case Body::kRing:
      return "the clamping ring";
    case Body::kHeld:
      return "what holds the part (part.held)";
    case Body::kRim:
      return "the rim of the bowl";
    case Body::kTable:
      return "the table";
    case Body::kSphere:
      return "a reference sphere";
    case Body::kStem:
      return "the stem of the reference sphere";
    case Body::kColumn:
      return "the reference column";
    case Body::kDowel:
      return "a dowel or bolt head of the fixture";
    case Body::kRingSphere:
      return "a sphere on the ring";
    case Body::kBody:
      return "the body";
    case Body::kPartMesh:
      return "the part, body";
    case Body::kVolume:
      return "the end of the machine's travel";
  }
  return "";
}

const char* name_of(Limb limb) {
  switch (limb) {
    case Limb::kBall:
      return "the ball of the stylus";
    case Limb::kShaft:
      return "the shaft of the stylus";
    case Limb::kHolder:
      return "the holder of the stylus";
  }
  return "";
}

bool is_part(Body body) {
  return body == Body::kFeature || body == Body::kSection || body == Body::kShoulder ||
         body == Body::kPartMesh;
}

double limb_radius(const Tool& tool, Limb limb) {
  if (limb == Limb::kBall) return tool.tip_radius_mm;
  return limb == Limb::kShaft ? tool.shaft_radius_mm : tool.holder_radius_mm;
}

bool has(const Tool& tool, Limb limb) {
  if (limb == Limb::kBall) return true;
  if (tool.shaft_length_mm <= 0.0) return false;
  return limb_radius(tool, limb) > 0.0;
}

/// The volume that a limb sweeps while the tip moves from a to b, machine frame.
Sweep sweep_of(const Tool& tool, Limb limb, const Vector3d& a, const Vector3d& b) {
  const Vector3d shaft = tool.shaft_length_mm * Vector3d::UnitZ();
  if (limb == Limb::kBall) return {a, b - a, Vector3d::Zero()};
  if (limb == Limb::kShaft) return {a, b - a, shaft};
  return {a + shaft, b - a, kHolder_mm * Vector3d::UnitZ()};
}

Sweep moved(const Sweep& sweep, const Eigen::Isometry3d& X) {
  return {X * sweep.start_mm, X.linear() * sweep.along_mm, X.linear() * sweep.up_mm};
}

}  // namespace

double length_mm(const Polyline& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

std::string in_words(const Hit& hit) {
  const Vector3d& p = hit.tip_W_mm;
  const std::string where =
      fmt::format("on the way to machine ({:.3f}, {:.3f}, {:.3f}) mm", p.x(), p.y(), p.z());
  if (hit.body == Body::kVolume) {
    return fmt::format("the tip would leave the volume of the machine {}", where);
  }
  const std::string name = hit.name.empty() ? hit.name : fmt::format(" \"{}\"", hit.name);
  std::string key = hit.key;
  if (!key.empty() && hit.location_mm > 0.0)
    key += fmt::format(" with {:.4g} mm by which the place may be off", hit.location_mm);
  if (hit.body_mm > 0.0)
    key += fmt::format("{}{:.4g} mm of the body", key.empty() ? "" : " and ", hit.body_mm);
  if (!key.empty()) key = " (" + key + ")";
  return fmt::format("{} would come nearer than {:.7g} mm{} to {}{} {}", name_of(hit.limb),
                     hit.gap_mm, key, name_of(hit.body), name, where);
}

Eigen::Isometry3d frame_of(BodyPlan::Frame frame, const FixturePlan& fixture,
                           const Placement& placement) {
  if (frame == BodyPlan::Frame::kBase) return Eigen::Isometry3d::Identity();
  if (frame == BodyPlan::Frame::kPart) return placement.X_WP;
  const Eigen::Isometry3d X_WB = placement.X_WN * nominal_seat(fixture).inverse();
  if (frame == BodyPlan::Frame::kRing) return X_WB;
  // The hoop turns about the base-fixed axis alone: its y is that of the ring, its x that axis.
  const Vector3d y = X_WB.linear().col(1);
  const Vector3d x = (Vector3d::UnitX() - y.x() * y).normalized();
  Eigen::Isometry3d X_WH = Eigen::Isometry3d::Identity();
  X_WH.linear() << x, y, x.cross(y);
  X_WH.translation() = X_WB.translation() - X_WH.linear() * vector3(fixture.axis_offset_mm);
  return X_WH;
}

Scene::Scene(const Plan& plan, const FeaturePlan& feature, const std::array<double, 3>* touched)
    : tool_(tool_of(plan)),
      fixture_(*plan.fixture),
      volume_min_mm_(vector3(plan.machine->volume_min_mm)),
      volume_max_mm_(vector3(plan.machine->volume_max_mm)) {
  if (is_touched(feature)) add_part(plan, feature);
  add_cell(plan, feature);
  add_spheres(plan, feature, touched);
  add_bodies(*plan.fixture, is_touched(feature));
}

void Scene::add(Body body, Frame frame, const Vector3d& origin_mm, const Revolved& shape) {
  Solid& added = solids_.emplace_back();
  added.body = body;
  added.frame = frame;
  added.shape = shape;
  added.into_own.translation() = -origin_mm;
}

/// @param with_part  Whether the ring holds the part, not balls.
void Scene::add_bodies(const FixturePlan& fixture, bool with_part) {
  for (const BodyPlan& body : fixture.bodies) {
    if (body.frame == BodyPlan::Frame::kPart && !with_part) continue;
    const bool mesh = body.shape == BodyPlan::Shape::kMesh;
    Solid& added = solids_.emplace_back();
    added.body = mesh && body.frame == BodyPlan::Frame::kPart ? Body::kPartMesh : Body::kBody;
    added.frame = Frame::kBodies;
    added.of = body.frame;
    added.into_own = placed_body(body).inverse();
    added.shape = {0.5 * body.bore_diameter_mm, 0.5 * body.diameter_mm, body.from_mm, body.to_mm};
    added.mesh = body.mesh;
    added.name = body.id;
    added.more_mm = body.clearance_mm;
    if (body.facets == BodyPlan::Facets::kRound) added.more_mm += body.mesh->sag_mm();
    // The base may stand beside its nominal place, and the hoop with it.
    if (fixture.datum && body.frame <= BodyPlan::Frame::kHoop)
      added.more_mm += fixture.datum->uncertainty_mm;
    if (added.body == Body::kPartMesh) added.more_mm -= kAlongPart_mm;
  }
}

void Scene::add_part(const Plan& plan, const FeaturePlan& feature) {
  const NominalPlan& n = feature.nominal;
  const bool bore = feature.side == record::Side::kInside;
  const PartPiece own = piece_of(feature);
  add(Body::kFeature, Frame::kPart, own.origin_mm, own.solid);
  const auto is_flush = [&](const PartPiece& piece) {
    switch (feature.type) {
      case record::Shape::kPlane:  // the material behind it
        return n.faces != record::Faces::kDown ? piece.to_mm() <= n.z_mm
                                               : piece.from_mm() >= n.z_mm;
      case record::Shape::kCone:
        return piece.radius_mm() <= own.solid.outer_mm + std::min(0.0, own.solid.widens_mm);
      case record::Shape::kSphere:
        return false;
      default:
        return bore ? 2.0 * piece.solid.inner_mm >= n.diameter_mm
                    : 2.0 * piece.radius_mm() <= n.diameter_mm;
    }
  };
  for (const PartPiece& piece : part_beside(plan, feature)) {
    add(is_flush(piece) ? Body::kSection : Body::kShoulder, Frame::kPart, piece.origin_mm,
        piece.solid);
  }
}

void Scene::add_cell(const Plan& plan, const FeaturePlan& feature) {
  const FixturePlan& fixture = *plan.fixture;
  if (fixture.ring_diameter_mm > 0.0 && fixture.clamp_from_mm < fixture.clamp_to_mm) {
    // A bore stays open above and below its ring.
    const double hole_mm =
        feature.side == record::Side::kInside ? 0.5 * feature.nominal.diameter_mm : 0.0;
    add(is_fixed(plan) ? Body::kHeld : Body::kRing, Frame::kSeat, Vector3d::Zero(),
        {hole_mm, 0.5 * fixture.ring_diameter_mm, fixture.clamp_from_mm, fixture.clamp_to_mm});
  }
  const Vector3d axis = vector3(fixture.axis_point_mm);
  const double rim_mm = fixture.rim_diameter_mm > 0.0 ? 0.5 * fixture.rim_diameter_mm : kWide_mm;
  add(Body::kRim, Frame::kMachine, {axis.x(), axis.y(), 0.0},
      {0.0, rim_mm, std::min(fixture.table_height_mm, fixture.rim_height_mm) - kDeep_mm,
       fixture.rim_height_mm});
  if (fixture.datum) solids_.back().more_mm = fixture.datum->uncertainty_mm;
  add(Body::kTable, Frame::kMachine, {axis.x(), axis.y(), 0.0},
      {0.0, kWide_mm, fixture.table_height_mm - kDeep_mm, fixture.table_height_mm});
}

void Scene::add_spheres(const Plan& plan, const FeaturePlan& feature,
                        const std::array<double, 3>* touched) {
  const FixturePlan& fixture = *plan.fixture;
  const QualificationPlan& q = plan.probe->qualification;
  const Vector3d qualified = vector3(q.place_mm());
  if (touched != &q.place_mm()) {
    const double radius_mm = 0.5 * q.diameter_mm();
    const double stem_mm = q.on_column()              ? radius_mm
                           : q.stem_diameter_mm > 0.0 ? 0.5 * q.stem_diameter_mm
                                                      : radius_mm / 3.0;
    if (!q.on_column()) {
      add(Body::kSphere, Frame::kMachine, qualified, {0.0, radius_mm, 0.0, 0.0, true});
    }
    add(q.on_column() ? Body::kColumn : Body::kStem, Frame::kMachine, qualified,
        {0.0, stem_mm, -kDeep_mm, q.on_column() ? q.column_to_mm : 0.0});
  }
  const Eigen::Isometry3d X_NB = nominal_seat(fixture).inverse();
  const auto add_all = [&](Body body, const auto& spheres, double radius_mm) {
    for (const auto& sphere : spheres) {
      if (&sphere.center_mm == touched) continue;
      const bool carried = body == Body::kRingSphere;  // the plan has its centre in the body frame
      const Vector3d center = vector3(sphere.center_mm);
      add(body, carried ? Frame::kSeat : Frame::kMachine,
          carried ? Vector3d(X_NB * center) : center, {0.0, radius_mm, 0.0, 0.0, true});
    }
  };
  if (const auto& datum = fixture.datum) {
    add_all(Body::kSphere, datum->spheres, 0.5 * datum->sphere_diameter_mm + datum->uncertainty_mm);
    for (const DatumHolePlan& of : datum->holes) {
      if (of.side == record::Side::kInside || &of.center_mm == touched) continue;
      const double off_mm = datum->uncertainty_mm + most_lean_rad(*datum) * of.depth_mm;
      add(Body::kDowel, Frame::kMachine, vector3(of.center_mm),
          {0.0, 0.5 * of.diameter_mm + off_mm, -kDeep_mm, of.depth_mm + datum->uncertainty_mm});
    }
  }
  if (const auto& on_ring = fixture.reached_pose) {
    add_all(Body::kRingSphere, on_ring->spheres, 0.5 * on_ring->sphere_diameter_mm);
  }
  if (const auto& rotary = feature.rotary_axes) {
    add_all(Body::kRingSphere, rotary->balls,
            0.5 * rotary->ball_diameter_mm + rotary->uncertainty_mm);
  }
}

std::optional<Scene::Gap> Scene::gap(Body body, Limb limb, Phase phase,
                                     const PathGeometry& geometry) {
  const Gap clearance{geometry.clearance_mm, "machine.clearance_mm"};
  const Gap approach{geometry.approach_mm, "machine.approach_mm"};
  if (!is_part(body) || phase == Phase::kTravel) return clearance;
  // The ball meets the surface wherever it is; a shoulder may be nearer to the shaft.
  const double off_mm = body == Body::kShoulder ? geometry.location_mm : 0.0;
  if (phase == Phase::kTouch && limb == Limb::kShaft) return Gap{kTouchGap_mm + off_mm, ""};
  if (phase == Phase::kTouch && limb == Limb::kBall && body != Body::kShoulder) return std::nullopt;
  return approach.mm < clearance.mm ? approach : clearance;
}

bool Scene::meets(Solid& solid, const Sweep& sweep, double room_mm) {
  if (solid.mesh) return solid.mesh->meets(sweep, room_mm);
  for (const Obstacle& known : solid.grown) {
    if (known.grown_mm() == room_mm) return known.meets(sweep);
  }
  return solid.grown.emplace_back(solid.shape, room_mm).meets(sweep);
}

Eigen::Isometry3d Scene::machine_into(const Solid& solid, const Placement& placement) const {
  switch (solid.frame) {
    case Frame::kMachine:
      return Eigen::Isometry3d::Identity();
    case Frame::kSeat:
      return placement.X_WN.inverse();
    case Frame::kPart:
      return placement.X_WP.inverse();
    case Frame::kBodies:
      return frame_of(solid.of, fixture_, placement).inverse();
  }
  return Eigen::Isometry3d::Identity();
}

bool Scene::inside_volume(const Vector3d& tip_W_mm) const {
  return (tip_W_mm.array() >= volume_min_mm_.array()).all() &&
         (tip_W_mm.array() <= volume_max_mm_.array()).all();
}

std::optional<Hit> Scene::first_hit(const Way& way, const Placement& placement,
                                    const PathGeometry& geometry) const {
  std::vector<Eigen::Isometry3d> into;
  for (const Solid& solid : solids_) {
    into.push_back(solid.into_own * machine_into(solid, placement));
  }
  for (std::size_t i = 1; i < way.corners.size(); ++i) {
    const Vector3d& a = way.corners[i - 1];
    const Vector3d& b = way.corners[i];
    if (!inside_volume(b)) return Hit{Body::kVolume, Limb::kBall, 0.0, "", 0.0, 0.0, b};
    for (const Limb limb : {Limb::kBall, Limb::kShaft, Limb::kHolder}) {
      if (!has(tool_, limb)) continue;
      const Sweep sweep = sweep_of(tool_, limb, a, b);
      for (std::size_t k = 0; k < solids_.size(); ++k) {
        Solid& solid = solids_[k];
        auto to_keep = gap(solid.body, limb, way.phases[i - 1], geometry);
        if (!to_keep) continue;
        to_keep->mm += solid.more_mm;
        if (meets(solid, moved(sweep, into[k]), limb_radius(tool_, limb) + to_keep->mm)) {
          return Hit{solid.body,
                     limb,
                     to_keep->mm,
                     to_keep->key,
                     geometry.location_mm,
                     std::max(0.0, solid.more_mm),
                     b,
                     solid.name};
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace rondure::plans
