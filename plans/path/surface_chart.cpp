#include "plans/path/surface_chart.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using record::Shape;

Vector3d in_polar(double radius_mm, double theta_rad, double z_mm) {
  return {radius_mm * std::cos(theta_rad), radius_mm * std::sin(theta_rad), z_mm};
}

}  // namespace

SurfaceChart::SurfaceChart(const FeaturePlan& feature)
    : shape_(feature.type),
      radius_mm_(0.5 * feature.nominal.diameter_mm),
      inside_(feature.side == record::Side::kInside),
      faces_(feature.nominal.faces.value_or(record::Faces::kUp)),
      from_mm_(feature.nominal.from_mm),
      half_angle_rad_(feature.nominal.half_angle_deg * core::kDegree),
      center_mm_(feature.nominal.center_mm[0], feature.nominal.center_mm[1],
                 feature.nominal.center_mm[2]) {
  if (shape_ != Shape::kPlane) return;
  const double width_mm = 0.5 * (feature.nominal.to_diameter_mm - feature.nominal.from_diameter_mm);
  const int layers = feature.sampling.layers;
  const double margin_mm = layers == 1 ? 0.5 * width_mm : feature.sampling.margin_mm;
  radius_mm_ = 0.5 * feature.nominal.from_diameter_mm + margin_mm;
  step_mm_ = layers == 1 ? 0.0 : (width_mm - 2.0 * margin_mm) / (layers - 1);
  inside_ = false;
}

bool SurfaceChart::is_round() const {
  return shape_ == Shape::kCylinder || shape_ == Shape::kCircle;
}

double SurfaceChart::ring_radius_mm(const Target& target) const {
  switch (shape_) {
    case Shape::kPlane:
      return radius_mm_ + target.layer * step_mm_;
    case Shape::kCone:
      return radius_mm_ + std::tan(half_angle_rad_) * (target.z_mm - from_mm_);
    case Shape::kSphere: {
      const double height_mm = target.z_mm - center_mm_.z();
      return std::sqrt(std::max(0.0, radius_mm_ * radius_mm_ - height_mm * height_mm));
    }
    default:
      return radius_mm_;
  }
}

Vector3d SurfaceChart::contact_point(const Target& target) const {
  const Vector3d point = in_polar(ring_radius_mm(target), target.theta_rad, target.z_mm);
  if (shape_ != Shape::kSphere) return point;
  return point + Vector3d(center_mm_.x(), center_mm_.y(), 0.0);
}

Vector3d SurfaceChart::normal(const Target& target) const {
  const double side = inside_ ? -1.0 : 1.0;
  switch (shape_) {
    case Shape::kPlane:
      return faces_up() ? Vector3d(Vector3d::UnitZ()) : Vector3d(-Vector3d::UnitZ());
    case Shape::kCone:
      return in_polar(side * std::cos(half_angle_rad_), target.theta_rad,
                      -side * std::sin(half_angle_rad_));
    case Shape::kSphere:
      return side / radius_mm_ * (contact_point(target) - center_mm_);
    default:
      return in_polar(side, target.theta_rad, 0.0);
  }
}

Vector3d SurfaceChart::approach(const Target& target) const {
  // Without the sign of a zero, which would change the last bit of a turned direction.
  if (is_round()) return in_polar(inside_ ? 1.0 : -1.0, target.theta_rad, 0.0);
  return -normal(target);
}

Vector3d SurfaceChart::tip(const Target& target, double tip_radius_mm, double gap_mm) const {
  if (is_round()) {
    const double side = inside_ ? -1.0 : 1.0;
    return in_polar(radius_mm_ + side * tip_radius_mm + side * gap_mm, target.theta_rad,
                    target.z_mm);
  }
  return contact_point(target) + (tip_radius_mm + gap_mm) * normal(target);
}

}  // namespace rondure::plans
