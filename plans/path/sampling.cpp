#include "plans/path/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace rondure::plans {
namespace {

core::Result<void> check_layers(const FeaturePlan& feature, int layers) {
  const SamplingPlan& sampling = feature.sampling;
  if (layers < 1) {
    return core::fail_with(core::Code::kSampling, "{} layers cannot be probed; give at least 1",
                           layers);
  }
  if (sampling.points_per_layer < 3) {
    return core::fail_with(core::Code::kSampling,
                           "{} points a layer do not determine a circle; give at least 3",
                           sampling.points_per_layer);
  }
  const double length_mm = layered_mm(feature);
  if (layers > 1 && !(sampling.margin_mm >= 0.0 && 2.0 * sampling.margin_mm < length_mm)) {
    return core::fail_with(
        core::Code::kSampling,
        "a margin of {:.7g} mm at both ends leaves no room for {} layers on {:.7g} mm",
        sampling.margin_mm, layers, length_mm);
  }
  return {};
}

double layer_height(const FeaturePlan& feature, int layer, int layers) {
  const NominalPlan& nominal = feature.nominal;
  if (feature.type == record::Shape::kPlane) return nominal.z_mm;
  if (layers == 1) return 0.5 * (nominal.from_mm + nominal.to_mm);
  const double margin_mm = feature.sampling.margin_mm;
  const double span_mm = nominal.to_mm - nominal.from_mm - 2.0 * margin_mm;
  return nominal.from_mm + margin_mm + layer * span_mm / (layers - 1);
}

/// Number of points on each ring, equator first, in proportion to its length; `points` in total.
std::vector<int> share_among_rings(int points, int rings) {
  std::vector<double> length;
  double total = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    length.push_back(std::cos(std::numbers::pi / 2.0 * ring / rings));
    total += length.back();
  }
  std::vector<int> share;
  int placed = 0;
  double passed = 0.0;
  for (const double ring_length : length) {
    passed += ring_length;
    const int up_to_here = static_cast<int>(std::lround(points * passed / total));
    share.push_back(up_to_here - placed);
    placed = up_to_here;
  }
  return share;
}

}  // namespace

double layered_mm(const FeaturePlan& feature) {
  const NominalPlan& n = feature.nominal;
  return feature.type == record::Shape::kPlane ? 0.5 * (n.to_diameter_mm - n.from_diameter_mm)
                                               : n.to_mm - n.from_mm;
}

core::Result<std::vector<double>> layer_heights_mm(const FeaturePlan& feature) {
  const int layers = feature.type == record::Shape::kCircle ? 1 : feature.sampling.layers;
  TRY_DO(check_layers(feature, layers));
  std::vector<double> out;
  for (int layer = 0; layer < layers; ++layer) out.push_back(layer_height(feature, layer, layers));
  return out;
}

core::Result<std::vector<Target>> sampling_targets(const FeaturePlan& feature) {
  TRY(const auto heights, layer_heights_mm(feature));
  const SamplingPlan& sampling = feature.sampling;
  const double step_rad = core::kTwoPi / sampling.points_per_layer;
  const int layers = static_cast<int>(heights.size());
  std::vector<Target> targets;
  for (int layer = 0; layer < layers; ++layer) {
    const double z_mm = heights[static_cast<std::size_t>(layer)];
    const double start_rad =
        sampling.start_deg * core::kDegree + sampling.stagger * layer * step_rad / layers;
    for (int point = 0; point < sampling.points_per_layer; ++point) {
      targets.push_back({layer, point, start_rad + point * step_rad, z_mm});
    }
  }
  return targets;
}

core::Result<std::vector<Target>> locating_targets(const FeaturePlan& feature,
                                                   double uncertainty_mm) {
  FeaturePlan locating = feature;
  const double length_mm = feature.nominal.to_mm - feature.nominal.from_mm;
  locating.type = record::Shape::kCylinder;  // the surface of a circle has an axis, too
  locating.sampling.layers = 2;
  locating.sampling.points_per_layer = 3;
  locating.sampling.stagger = 1.0;
  // A fifth of the length must remain between the layers to determine the tilt.
  locating.sampling.margin_mm =
      std::min(feature.sampling.margin_mm + uncertainty_mm, 0.4 * length_mm);
  return sampling_targets(locating);
}

core::Result<std::vector<Target>> height_targets(const FeaturePlan& face) {
  FeaturePlan locating = face;
  locating.sampling.points_per_layer = 3;
  TRY(auto targets, sampling_targets(locating));
  const int middle = (face.sampling.layers - 1) / 2;
  std::erase_if(targets, [&](const Target& target) { return target.layer != middle; });
  return targets;
}

core::Result<std::vector<Eigen::Vector3d>> qualification_directions(int points) {
  if (points < 5 || points > 100) {
    return core::fail_with(core::Code::kSampling,
                           "{} touches of the reference sphere are outside 5..100", points);
  }
  // Ring spacing equal to the point spacing of an even spread: sqrt(2 pi / points) on the
  // hemisphere.
  const double spacing_rad = std::sqrt(core::kTwoPi / points);
  const int rings =
      points < 9 ? 1 : static_cast<int>(std::lround(std::numbers::pi / 2.0 / spacing_rad));
  const std::vector<int> share = share_among_rings(points - 1, rings);
  std::vector<Eigen::Vector3d> directions = {Eigen::Vector3d::UnitZ()};
  for (int ring = rings - 1; ring >= 0; --ring) {
    const int around = share[static_cast<std::size_t>(ring)];
    const double elevation_rad = std::numbers::pi / 2.0 * ring / rings;
    for (int i = 0; i < around; ++i) {
      const double theta_rad = core::kTwoPi * (i + 0.5 * (ring % 2)) / around;
      directions.emplace_back(std::cos(elevation_rad) * std::cos(theta_rad),
                              std::cos(elevation_rad) * std::sin(theta_rad),
                              ring == 0 ? 0.0 : std::sin(elevation_rad));
    }
  }
  return directions;
}

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
