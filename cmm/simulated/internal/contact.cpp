#include "cmm/simulated/internal/contact.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "cmm/simulated/internal/side_contact.h"
#include "cmm/simulated/internal/surface_shape.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Segment {
  Vector3d a;
  Vector3d b;
};

/// The part of a segment with |z| <= limit.
std::optional<Segment> clip_to_slab(const Segment& whole, double limit) {
  const Vector3d ab = whole.b - whole.a;
  if (std::abs(ab.z()) < 1e-12) {
    return std::abs(whole.a.z()) <= limit ? std::optional(whole) : std::nullopt;
  }
  const double t1 = (-limit - whole.a.z()) / ab.z();
  const double t2 = (limit - whole.a.z()) / ab.z();
  const double from = std::max(0.0, std::min(t1, t2));
  const double to = std::min(1.0, std::max(t1, t2));
  if (from > to) return std::nullopt;
  return Segment{whole.a + from * ab, whole.a + to * ab};
}

/// Distance of the z axis from a segment projected along z.
double nearest_to_axis(const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab).norm();
}

/// True when a sphere is certain to stay clear of the solid on the straight line from a to b (part
/// frame); false when a closer check is needed. Costs a few dozen operations.
/// @param deviation_mm  Bound of the form toward the free side (shape_bounds()).
bool surely_clear(const PartSurface& surface, double deviation_mm, const Vector3d& a_P_mm,
                  const Vector3d& b_P_mm, double sphere_radius_mm) {
  const auto beside = clip_to_slab({a_P_mm, b_P_mm}, surface.half_length_mm + sphere_radius_mm);
  if (!beside) return true;
  const double nearest = nearest_to_axis(beside->a.head<2>(), beside->b.head<2>());
  const double keep_off = sphere_radius_mm + deviation_mm;
  if (!surface.inside) return nearest > surface.radius_mm + keep_off;
  const double farthest = std::max(beside->a.head<2>().norm(), beside->b.head<2>().norm());
  return farthest < surface.radius_mm - keep_off ||
         nearest > surface.radius_mm + surface.wall_mm + sphere_radius_mm;
}

constexpr double kOverlap_mm = 1e-9;

/// Whether a point of an end plane belongs to the flat end.
bool on_end(const PartSurface& surface, const Vector3d& p) {
  const double from_axis = std::hypot(p.x(), p.y());
  const double rim = surface.radius_at(std::atan2(p.y(), p.x()), p.z());
  if (!surface.inside) return from_axis <= rim;
  return from_axis >= rim && from_axis <= surface.radius_mm + surface.wall_mm;
}

/// Whether a point is within the material.
bool in_material(const PartSurface& surface, const Vector3d& p) {
  return std::abs(p.z()) <= surface.half_length_mm && on_end(surface, p);
}

/// Contact with the flat of the upper (side = 1) or lower (-1) end, without its rim.
std::optional<SideContact> end_contact(const PartSurface& surface, const SphereSweep& sweep,
                                       double side) {
  const double height = side * sweep.start_P_mm.z() - surface.half_length_mm;  // above the end
  if (height < 0.0) return std::nullopt;
  const auto foot = [&](double travel) {
    Vector3d p = sweep.start_P_mm + travel * sweep.direction_P;
    p.z() = side * surface.half_length_mm;
    return p;
  };
  if (height < sweep.radius_mm && on_end(surface, foot(0.0))) {
    return SideContact{height - sweep.radius_mm, foot(0.0)};
  }
  const double speed = -side * sweep.direction_P.z();
  if (speed <= 0.0 || height < sweep.radius_mm) return std::nullopt;
  const double travel = (height - sweep.radius_mm) / speed;
  if (travel > sweep.travel_mm || !on_end(surface, foot(travel))) return std::nullopt;
  return SideContact{travel, foot(travel)};
}

/// The outer wall of the block around a bore, as a shaft of ideal form.
PartSurface block_wall(const PartSurface& bore) {
  return {bore.radius_mm + bore.wall_mm, bore.half_length_mm, false, {}, {}};
}

core::Error in_contact_already() {
  return {core::Code::kCollision, "the tip overlaps the part before the motion starts", {}};
}

core::Error no_contact(double max_travel_mm) {
  return {core::Code::kNoTouch,
          fmt::format("no contact within {:.3f} mm of travel", max_travel_mm),
          {}};
}

core::Result<Contact> as_contact(const std::optional<SideContact>& first,
                                 const SphereSweep& sweep) {
  if (!first) return core::fail(no_contact(sweep.travel_mm));
  if (first->travel_mm < -kOverlap_mm) return core::fail(in_contact_already());
  Contact contact;
  contact.travel_mm = std::max(first->travel_mm, 0.0);
  contact.tip_P_mm = sweep.start_P_mm + contact.travel_mm * sweep.direction_P;
  contact.point_P_mm = first->point_P_mm;
  return contact;
}

/// Curvature of the form times radius of the tip up to which the shift by the form has one value.
constexpr double kGentle = 0.5;

core::Error too_rough(const char* what) {
  return {core::Code::kNotConverged,
          fmt::format("the waves of the simulated {} are too steep for the tip; lower their "
                      "amplitude or their order",
                      what),
          {}};
}

/// The fixed point of a function that contracts.
template <class Function>
core::Result<Vector3d> settled(const Function& next) {
  constexpr int kIterations = 200;
  constexpr double kStep_mm = 1e-13;
  Vector3d value = Vector3d::Zero();
  for (int i = 0; i < kIterations; ++i) {
    const Vector3d last = value;
    value = next(last);
    if ((value - last).norm() <= kStep_mm) return value;
  }
  return core::fail(core::Code::kNotConverged,
                    "the contact of tip and part was not found within the iteration limit");
}

}  // namespace

core::Result<Contact> first_contact(const PartSurface& surface, const Vector3d& start_P_mm,
                                    const Vector3d& direction_P, double tip_radius_mm,
                                    double max_travel_mm) {
  const SphereSweep sweep = {start_P_mm, direction_P, tip_radius_mm, max_travel_mm};
  const Vector3d end_P_mm = start_P_mm + max_travel_mm * direction_P;
  if (surely_clear(surface, shape_bounds(surface).toward_free_mm, start_P_mm, end_P_mm,
                   tip_radius_mm)) {
    return core::fail(no_contact(max_travel_mm));
  }
  if (in_material(surface, start_P_mm)) return core::fail(in_contact_already());
  TRY(const auto side, first_side_contact(surface, sweep));
  std::optional<SideContact> first = side;
  const auto keep_first = [&first](const std::optional<SideContact>& other) {
    if (other && (!first || other->travel_mm < first->travel_mm)) first = other;
  };
  if (surface.upper_end) keep_first(end_contact(surface, sweep, 1.0));
  if (surface.lower_end) keep_first(end_contact(surface, sweep, -1.0));
  const bool within_bore = start_P_mm.head<2>().norm() < surface.radius_mm &&
                           std::abs(start_P_mm.z()) < surface.half_length_mm;
  if (surface.inside && !within_bore) {
    TRY(const auto wall, first_side_contact(block_wall(surface), sweep));
    keep_first(wall);
  }
  return as_contact(first, sweep);
}

core::Result<Contact> first_contact(const FaceSurface& surface, const Vector3d& start_P_mm,
                                    const Vector3d& direction_P, double tip_radius_mm,
                                    double max_travel_mm) {
  const SphereSweep sweep = {start_P_mm, direction_P, tip_radius_mm, max_travel_mm};
  const double k = std::max(2, surface.wave_order);
  const double curvature_1_mm =
      (2.0 * std::abs(surface.saucer_mm) + k * k * std::abs(surface.wave_mm)) /
      (surface.outer_mm * surface.outer_mm);
  if (curvature_1_mm * tip_radius_mm >= kGentle) return core::fail(too_rough("face"));
  const auto on_ring = [&](const Vector3d& foot) {
    const double q = foot.head<2>().norm();
    return q >= surface.inner_mm && q <= surface.outer_mm;
  };
  // A ball on a plane at height 0 has its centre at the height of its radius over its foot; the
  // form moves the centre by `shift`, which depends on the foot alone.
  const auto shift_at = [&](const Vector3d& foot) {
    const Eigen::Vector2d slope = surface.slope_at(foot.x(), foot.y());
    const Vector3d normal = Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
    return Vector3d(surface.height_at(foot.x(), foot.y()) * Vector3d::UnitZ() +
                    tip_radius_mm * (normal - Vector3d::UnitZ()));
  };
  TRY(const auto at_start,
      settled([&](const Vector3d& shift) { return shift_at(start_P_mm - shift); }));
  const double gap_mm = start_P_mm.z() - at_start.z() - tip_radius_mm;
  if (gap_mm < -kOverlap_mm && gap_mm > -tip_radius_mm && on_ring(start_P_mm - at_start)) {
    return core::fail(in_contact_already());
  }
  if (direction_P.z() >= 0.0 || gap_mm < -kOverlap_mm) return core::fail(no_contact(max_travel_mm));
  const auto travel_with = [&](const Vector3d& shift) {
    return (tip_radius_mm + shift.z() - start_P_mm.z()) / direction_P.z();
  };
  if (travel_with(at_start) > max_travel_mm + surface.outer_mm) {
    return core::fail(no_contact(max_travel_mm));
  }
  TRY(const auto shift, settled([&](const Vector3d& last) {
        return shift_at(start_P_mm + travel_with(last) * direction_P - last);
      }));
  const double travel_mm = travel_with(shift);
  Vector3d foot = start_P_mm + travel_mm * direction_P - shift;
  foot.z() = surface.height_at(foot.x(), foot.y());
  if (travel_mm > max_travel_mm || !on_ring(foot)) return core::fail(no_contact(max_travel_mm));
  return as_contact(SideContact{travel_mm, foot}, sweep);
}

core::Result<Contact> first_contact(const BallSurface& surface, const Vector3d& start_P_mm,
                                    const Vector3d& direction_P, double tip_radius_mm,
                                    double max_travel_mm) {
  const SphereSweep sweep = {start_P_mm, direction_P, tip_radius_mm, max_travel_mm};
  double curvature_1_mm = 0.0;
  for (const Lobe& lobe : surface.lobes) {
    curvature_1_mm += std::abs(lobe.amplitude_mm) * lobe.order * lobe.order /
                      (surface.radius_mm * surface.radius_mm);
  }
  if (curvature_1_mm * tip_radius_mm >= kGentle) return core::fail(too_rough("ball"));
  const double reach_mm = surface.radius_mm + tip_radius_mm;
  const auto shift_at = [&](const Vector3d& toward) {
    const Vector3d u = toward.normalized();
    return Vector3d(surface.radius_at(u) * u + tip_radius_mm * surface.normal_at(u) - reach_mm * u);
  };
  TRY(const auto at_start,
      settled([&](const Vector3d& shift) { return shift_at(start_P_mm - shift); }));
  if ((start_P_mm - at_start).norm() < reach_mm - kOverlap_mm) {
    return core::fail(in_contact_already());
  }
  // Where the line misses a ball moved so far, the place nearest to it stands for the contact.
  bool meets = false;
  double travel_mm = 0.0;
  TRY(const auto shift, settled([&](const Vector3d& last) {
        const Vector3d from = start_P_mm - last;
        const double along = direction_P.dot(from);
        const double depth2 = along * along - from.squaredNorm() + reach_mm * reach_mm;
        meets = along < 0.0 && depth2 >= 0.0;
        travel_mm = -along - std::sqrt(std::max(0.0, depth2));
        return shift_at(from + travel_mm * direction_P);
      }));
  if (!meets || travel_mm > max_travel_mm) return core::fail(no_contact(max_travel_mm));
  const Vector3d u = (start_P_mm + travel_mm * direction_P - shift).normalized();
  return as_contact(SideContact{travel_mm, surface.radius_at(u) * u}, sweep);
}

core::Result<Contact> first_contact_with_sphere(const Vector3d& center_mm, double radius_mm,
                                                const Vector3d& start_mm, const Vector3d& direction,
                                                double tip_radius_mm, double max_travel_mm) {
  const SphereSweep sweep = {start_mm, direction, tip_radius_mm, max_travel_mm};
  const Vector3d to_center = center_mm - start_mm;
  const double reach = radius_mm + tip_radius_mm;
  if (to_center.norm() < reach - kOverlap_mm) return core::fail(in_contact_already());
  const double along = direction.dot(to_center);
  const double depth2 = reach * reach - (to_center - along * direction).squaredNorm();
  if (along < 0.0 || depth2 < 0.0) return core::fail(no_contact(max_travel_mm));
  const double travel = along - std::sqrt(depth2);
  if (travel > max_travel_mm) return core::fail(no_contact(max_travel_mm));
  const Vector3d tip = start_mm + travel * direction;
  return as_contact(SideContact{travel, center_mm + radius_mm * (tip - center_mm).normalized()},
                    sweep);
}

}  // namespace rondure::cmm
