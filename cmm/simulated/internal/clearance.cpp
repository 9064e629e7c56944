#include "cmm/simulated/internal/clearance.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

}  // namespace

bool surely_clear(const PartSurface& surface, double deviation_mm, const Vector3d& a_P_mm,
                  const Vector3d& b_P_mm, double sphere_radius_mm) {
  const auto beside = clip_to_slab({a_P_mm, b_P_mm}, surface.half_length_mm + sphere_radius_mm);
  if (!beside) return true;
  const double nearest = nearest_to_axis(beside->a.head<2>(), beside->b.head<2>());
  const double keep_off = sphere_radius_mm + deviation_mm;
  if (!surface.inside) return nearest > surface.radius_mm + keep_off;
  const double farthest = std::max(beside->a.head<2>().norm(), beside->b.head<2>().norm());
  return farthest < surface.radius_mm - keep_off ||
         nearest > surface.radius_mm + kBlockWall_mm + sphere_radius_mm;
}

}  // namespace rondure::cmm
