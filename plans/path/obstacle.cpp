#include "plans/path/obstacle.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "core/units.h"

namespace rondure::plans {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 4>;  // around the parallelogram

constexpr double kGraze_mm = 1e-6;   // round-off of paths laid exactly at the limit
constexpr double kFacet_mm = 0.02;   // largest distance of a facet from a round wall
constexpr double kFlat_mm2 = 1e-12;  // area below which a parallelogram is a segment
constexpr double kArcSide_rad = std::numbers::pi / 6.0;  // longest side around an edge

Corners corners_of(const Sweep& s) {
  return {s.start_mm, s.start_mm + s.along_mm, s.start_mm + s.along_mm + s.up_mm,
          s.start_mm + s.up_mm};
}

double distance_of_origin(const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab).norm();
}

/// Distance of the z axis from the parallelogram projected along z; 0 when the axis passes through
/// it.
double from_axis(const Corners& c) {
  double nearest = std::numeric_limits<double>::infinity();
  int left = 0;
  int right = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Vector2d a = c[i].head<2>();
    const Vector2d b = c[(i + 1) % c.size()].head<2>();
    nearest = std::min(nearest, distance_of_origin(a, b));
    const double side = a.x() * b.y() - a.y() * b.x();
    left += side > 0.0 ? 1 : 0;
    right += side < 0.0 ? 1 : 0;
  }
  return left == 4 || right == 4 ? 0.0 : nearest;
}

/// Whether a plane that is tangent to the grown ball or frustum beside a corner separates it from
/// the sweep.
bool tangent_apart(const Revolved& solid, double room_mm, const Corners& c) {
  const double wall_rad = std::atan2(solid.widens_mm, solid.to_mm - solid.from_mm);
  return std::any_of(c.begin(), c.end(), [&](const Vector3d& beside) {
    Vector3d normal = beside.normalized();
    double off_mm = solid.outer_mm;
    if (!solid.ball) {
      const double theta_rad = std::atan2(beside.y(), beside.x());
      normal = {std::cos(wall_rad) * std::cos(theta_rad), std::cos(wall_rad) * std::sin(theta_rad),
                -std::sin(wall_rad)};
      off_mm = std::cos(wall_rad) * solid.outer_mm - std::sin(wall_rad) * solid.from_mm;
    }
    return std::all_of(c.begin(), c.end(),
                       [&](const Vector3d& p) { return normal.dot(p) >= off_mm + room_mm; });
  });
}

/// Whether a plane across the axis, or a cylinder about it, certainly separates sweep and solid.
bool surely_apart(const Revolved& solid, double room_mm, const Corners& c) {
  const double from_mm = solid.ball ? -solid.outer_mm : solid.from_mm;
  const double to_mm = solid.ball ? solid.outer_mm : solid.to_mm;
  const auto z = [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); };
  if (std::min_element(c.begin(), c.end(), z)->z() >= to_mm + room_mm) return true;
  if (std::max_element(c.begin(), c.end(), z)->z() <= from_mm - room_mm) return true;
  if (from_axis(c) >= solid.widest_mm() + room_mm) return true;
  if (solid.touched && tangent_apart(solid, room_mm, c)) return true;
  if (solid.inner_mm <= room_mm) return false;
  return std::all_of(c.begin(), c.end(), [&](const Vector3d& p) {
    return p.head<2>().norm() <= solid.inner_mm - room_mm;
  });
}

/// Adds the corners of a polygon around a part of a circle, tangent to it at both ends.
void add_arc(const Vector2d& center, double radius_mm, double start_rad, double turn_rad,
             std::vector<Vector2d>& out) {
  const int sides = std::max(1, static_cast<int>(std::ceil(turn_rad / kArcSide_rad - 1e-9)));
  const double side_rad = turn_rad / sides;
  const double corner_mm = radius_mm / std::cos(0.5 * side_rad);
  const auto add = [&](double distance_mm, double angle_rad) {
    out.push_back(center + distance_mm * Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  };
  add(radius_mm, start_rad);
  for (int i = 0; i < sides; ++i) add(corner_mm, start_rad + (i + 0.5) * side_rad);
  add(radius_mm, start_rad + turn_rad);
}

/// Outline of the grown solid, from below outward and up.
std::vector<Vector2d> grown_outline(const Revolved& solid, double room_mm) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  std::vector<Vector2d> out;
  if (solid.ball) {
    const double radius_mm = solid.outer_mm + room_mm;
    constexpr int kSides = 36;
    const double side_rad = std::numbers::pi / kSides;
    const double corner_mm = radius_mm / std::cos(0.5 * side_rad);
    out.emplace_back(0.0, -radius_mm);
    for (int i = 0; i < kSides; ++i) {
      const double angle_rad = -kQuarter + (i + 0.5) * side_rad;
      out.emplace_back(corner_mm * std::cos(angle_rad), corner_mm * std::sin(angle_rad));
    }
    out.emplace_back(0.0, radius_mm);
    return out;
  }
  const bool ring = solid.inner_mm > room_mm;
  if (!ring) out.emplace_back(0.0, solid.from_mm - room_mm);
  // The wall of a frustum that widens upward looks down.
  const double look_rad = -std::atan2(solid.widens_mm, solid.to_mm - solid.from_mm);
  add_arc({solid.outer_mm, solid.from_mm}, room_mm, -kQuarter, kQuarter + look_rad, out);
  add_arc({solid.outer_mm + solid.widens_mm, solid.to_mm}, room_mm, look_rad, kQuarter - look_rad,
          out);
  if (ring) {
    add_arc({solid.inner_mm, solid.to_mm}, room_mm, kQuarter, kQuarter, out);
    add_arc({solid.inner_mm, solid.from_mm}, room_mm, 2.0 * kQuarter, kQuarter, out);
  } else {
    out.emplace_back(0.0, solid.to_mm + room_mm);
  }
  return out;
}

/// Distance of a point of the (r, z) half plane from the profile of a solid with a slanting wall.
double from_frustum(const Revolved& solid, double r, double z) {
  const std::array<Vector2d, 4> corners = {
      {{solid.inner_mm, solid.from_mm},
       {solid.outer_mm, solid.from_mm},
       {solid.outer_mm + solid.widens_mm, solid.to_mm},
       {solid.inner_mm, solid.to_mm}}};  // around it, the solid to the left
  const Vector2d p(r, z);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d a = corners[i] - p;
    const Vector2d b = corners[(i + 1) % corners.size()] - p;
    inside = inside && a.x() * b.y() - a.y() * b.x() >= 0.0;
    nearest = std::min(nearest, distance_of_origin(a, b));
  }
  return inside ? 0.0 : nearest;
}

int facets_for(double radius_mm) {
  const double half_rad = std::acos(radius_mm / (radius_mm + kFacet_mm));
  return std::clamp(static_cast<int>(std::ceil(std::numbers::pi / half_rad)), 24, 180);
}

}  // namespace

double distance_mm(const Revolved& solid, const Vector3d& point_mm) {
  if (solid.ball) return std::max(0.0, point_mm.norm() - solid.outer_mm);
  const double r = point_mm.head<2>().norm();
  if (solid.widens_mm != 0.0) return from_frustum(solid, r, point_mm.z());
  const double out_r = std::max({solid.inner_mm - r, r - solid.outer_mm, 0.0});
  const double out_z = std::max({solid.from_mm - point_mm.z(), point_mm.z() - solid.to_mm, 0.0});
  return std::hypot(out_r, out_z);
}

Obstacle::Obstacle(const Revolved& solid, double grown_mm) : solid_(solid), grown_mm_(grown_mm) {}

const RevolvedMesh& Obstacle::mesh() const {
  if (!mesh_) {
    const double room_mm = grown_mm_ - kGraze_mm;
    const int facets = facets_for(solid_.widest_mm() + room_mm);
    std::vector<Vector2d> outline = grown_outline(solid_, room_mm);
    // Facets around the outer wall touch it from outside, those of a hole lie inside it: the mesh
    // contains the solid.
    const double widen = 1.0 / std::cos(std::numbers::pi / facets);
    const double hole_mm = solid_.inner_mm > room_mm ? solid_.inner_mm : -1.0;
    for (Vector2d& corner : outline) {
      if (corner.x() > hole_mm) corner.x() *= widen;
    }
    mesh_ = std::make_unique<RevolvedMesh>(outline, facets);
  }
  return *mesh_;
}

bool Obstacle::meets(const Sweep& sweep) const {
  ++questions_of_thread().asked;
  const Corners c = corners_of(sweep);
  const double room_mm = grown_mm_ - kGraze_mm;
  if (surely_apart(solid_, room_mm, c)) return false;
  for (const Vector3d& corner : c) {
    if (distance_mm(solid_, corner) < room_mm) return true;
  }
  if (sweep.along_mm.cross(sweep.up_mm).norm() > kFlat_mm2) {
    ++questions_of_thread().on_meshes;
    return mesh().meets(c[0], c[1], c[2]) || mesh().meets(c[0], c[2], c[3]);
  }
  // Flat: the longest of the spans between two corners contains the others.
  std::size_t far_a = 0;
  std::size_t far_b = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t j = i + 1; j < c.size(); ++j) {
      if ((c[i] - c[j]).norm() > (c[far_a] - c[far_b]).norm()) {
        far_a = i;
        far_b = j;
      }
    }
  }
  if (far_a == far_b) return false;
  ++questions_of_thread().on_meshes;
  return mesh().meets(c[far_a], c[far_b]);
}

}  // namespace rondure::plans
