#include "evaluation/uncertainty/cloud.h"

#include <cmath>

#include "core/decompositions.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Axis and radius by least squares.
core::Result<FormCloud> located(FormKind kind, std::span<const Vector3d> points_mm,
                                const std::optional<Vector3d>& near_direction) {
  FormCloud cloud;
  cloud.kind = kind;
  if (kind != FormKind::kRoundness) {
    TRY(const auto cylinder, fit::ls_cylinder(points_mm, near_direction));
    cloud.axis = cylinder.axis;
    cloud.radius_mm = cylinder.radius_mm;
    return cloud;
  }
  cloud.axis.direction = near_direction.value_or(Vector3d::UnitZ()).normalized();
  const auto across = fit::across(cloud.axis.direction);
  const Vector3d origin = points_mm.empty() ? Vector3d::Zero() : points_mm.front();
  std::vector<Eigen::Vector2d> plane;
  plane.reserve(points_mm.size());
  for (const Vector3d& p : points_mm) plane.emplace_back(across.transpose() * (p - origin));
  TRY(const auto circle, fit::ls_circle(plane));
  cloud.axis.point_mm = origin + across * circle.center_mm;
  cloud.radius_mm = circle.radius_mm;
  return cloud;
}

}  // namespace

core::Result<FormCloud> form_cloud(FormKind kind, std::span<const Vector3d> points_mm,
                                   const std::optional<Vector3d>& near_direction) {
  auto cloud = located(kind, points_mm, near_direction);
  if (!cloud) return cloud;
  const auto across = fit::across(cloud->axis.direction);
  const double last = std::max(1.0, static_cast<double>(points_mm.size()) - 1.0);
  for (const Vector3d& p : points_mm) {
    const Vector3d from_axis = p - cloud->axis.point_mm;
    const Eigen::Vector2d in_plane = across.transpose() * from_axis;
    FormPoint point;
    point.angle_rad = std::atan2(in_plane.y(), in_plane.x());
    if (kind != FormKind::kRoundness) {
      point.height_mm = from_axis.dot(cloud->axis.direction);
    }
    point.deviation_mm = in_plane.norm() - cloud->radius_mm;
    point.time_1 = static_cast<double>(cloud->points.size()) / last;
    cloud->points.push_back(point);
  }
  return cloud;
}

core::Result<FormCloud> sections_cloud(std::span<const std::vector<Vector3d>> sections_mm,
                                       const Vector3d& direction) {
  FormCloud out;
  out.kind = FormKind::kSections;
  out.axis = {Vector3d::Zero(), direction.normalized()};
  const double count = static_cast<double>(sections_mm.size());
  std::vector<FormCloud> sections;
  for (const std::vector<Vector3d>& points : sections_mm) {
    TRY(auto section, form_cloud(FormKind::kRoundness, points, direction));
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
    const double along = (middle - section.axis.point_mm).dot(out.axis.direction);
    section.axis.point_mm += along * out.axis.direction;
    out.axis.point_mm += section.axis.point_mm / count;
    out.radius_mm += section.radius_mm / count;
    sections.push_back(std::move(section));
  }
  for (std::size_t s = 0; s < sections.size(); ++s) {
    for (FormPoint& point : sections[s].points) {
      point.section = static_cast<int>(s);
      point.height_mm = (sections[s].axis.point_mm - out.axis.point_mm).dot(out.axis.direction);
      point.deviation_mm += sections[s].radius_mm - out.radius_mm;
      out.points.push_back(point);
    }
  }
  return out;
}

Vector3d outward_normal(const FormCloud& cloud, const FormPoint& point) {
  const auto across = fit::across(cloud.axis.direction);
  return across * Eigen::Vector2d(std::cos(point.angle_rad), std::sin(point.angle_rad));
}

Vector3d position_mm(const FormCloud& cloud, const FormPoint& point) {
  return cloud.axis.point_mm + point.height_mm * cloud.axis.direction +
         (cloud.radius_mm + point.deviation_mm) * outward_normal(cloud, point);
}

Eigen::MatrixXd rigid_motions(const FormCloud& cloud) {
  const Index n = static_cast<Index>(cloud.points.size());
  const bool tilts = cloud.kind == FormKind::kCylindricity;
  const bool plane = cloud.kind == FormKind::kFlatness;
  double middle = 0.0;
  for (const FormPoint& p : cloud.points) middle += p.height_mm / static_cast<double>(n);
  double reach = 0.0;
  for (const FormPoint& p : cloud.points) {
    reach = std::max(reach, std::abs(p.height_mm - middle));
  }
  const Index sections = cloud.kind == FormKind::kSections ? cloud.points.back().section + 1 : 1;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, tilts ? 5 : 3 * sections);
  for (Index i = 0; i < n; ++i) {
    const FormPoint& p = cloud.points[static_cast<std::size_t>(i)];
    const double arm = plane ? p.height_mm / cloud.radius_mm : 1.0;
    const double c = arm * std::cos(p.angle_rad);
    const double s = arm * std::sin(p.angle_rad);
    const double q = reach > 0.0 ? (p.height_mm - middle) / reach : 0.0;
    out.row(i).segment(Index{3} * p.section, 3) << 1.0, c, s;
    if (tilts) out.row(i).tail(2) << q * c, q * s;
  }
  return out;
}

Eigen::MatrixXd rigid_basis(const FormCloud& cloud) {
  return core::column_space(rigid_motions(cloud), 1e-9);
}

}  // namespace rondure::evaluation
