#include "evaluation/part/internal/chart.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "evaluation/results/measured_cloud.h"
#include "fit/least_squares/plane.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using Eigen::Vector3d;

/// Slope of the distances along the axis: tangent of the half angle of a cone.
struct Slope {
  double at_middle_mm = 0.0;
  double per_mm = 0.0;
};

Slope slope_of(const FormCloud& cloud) {
  double height = 0.0;
  double distance = 0.0;
  for (const FormPoint& p : cloud.points) {
    height += p.height_mm;
    distance += cloud.radius_mm + p.deviation_mm;
  }
  const auto count = static_cast<double>(cloud.points.size());
  height /= count;
  distance /= count;
  double both = 0.0;
  double square = 0.0;
  for (const FormPoint& p : cloud.points) {
    both += (p.height_mm - height) * (cloud.radius_mm + p.deviation_mm - distance);
    square += (p.height_mm - height) * (p.height_mm - height);
  }
  const double per_mm = square > 0.0 ? both / square : 0.0;
  return {distance - per_mm * height, per_mm};
}

core::Result<Chart> chart_of_plane(std::span<const Vector3d> tips) {
  TRY(const auto plane, fit::ls_plane(tips));
  Chart out;
  out.cloud.kind = FormKind::kFlatness;
  out.cloud.axis = {plane.plane.point_mm, plane.plane.normal};
  const auto across = fit::across(plane.plane.normal);
  double least = 0.0;
  double greatest = 0.0;
  for (const Vector3d& tip : tips) {
    const Eigen::Vector2d place = across.transpose() * (tip - plane.plane.point_mm);
    FormPoint point;
    point.angle_rad = std::atan2(place.y(), place.x());
    point.height_mm = place.norm();
    point.deviation_mm = fit::height_mm(plane.plane, tip);
    point.time_1 = static_cast<double>(out.normals.size()) / static_cast<double>(tips.size());
    least = out.cloud.points.empty() ? point.height_mm : std::min(least, point.height_mm);
    greatest = std::max(greatest, point.height_mm);
    out.cloud.points.push_back(point);
    out.normals.push_back(plane.plane.normal);
  }
  out.cloud.radius_mm = greatest;
  if (greatest - least < 1e-3 * greatest) {  // one circle: its height and its tilt alone
    out.cloud.kind = FormKind::kRoundness;
    for (FormPoint& point : out.cloud.points) point.height_mm = 0.0;
  }
  return out;
}

core::Result<Chart> chart_of_tips(const FeatureResult& result, std::span<const Vector3d> tips) {
  using record::Shape;
  const Shape shape = result.feature.shape;
  if (shape == Shape::kPlane) return chart_of_plane(tips);
  if (shape == Shape::kSphere || record::is_analysis(shape)) {
    return core::fail(Code::kMeaning,
                      core::phrase("intervals of this kind of feature are not computed"));
  }
  std::optional<Vector3d> direction;
  if (result.ls_cylinder) direction = result.ls_cylinder->axis.direction;
  const bool circle = shape == Shape::kCircle;
  if (circle) direction = result.section_axis.direction;
  TRY(auto cloud,
      form_cloud(circle ? FormKind::kRoundness : FormKind::kCylindricity, tips, direction));
  Chart out{std::move(cloud), {}, {}};
  const bool cone = shape == Shape::kCone;
  const Slope slope = cone ? slope_of(out.cloud) : Slope{out.cloud.radius_mm, 0.0};
  const double cosine = 1.0 / std::hypot(1.0, slope.per_mm);
  for (FormPoint& point : out.cloud.points) {
    const Vector3d radial = outward_normal(out.cloud, point);
    if (!cone) {
      out.normals.push_back(radial);
      continue;
    }
    out.normals.push_back(cosine * (radial - slope.per_mm * out.cloud.axis.direction));
    point.deviation_mm = cosine * (out.cloud.radius_mm + point.deviation_mm - slope.at_middle_mm -
                                   slope.per_mm * point.height_mm);
  }
  return out;
}

}  // namespace

core::Result<Chart> chart_of(const FeatureResult& result, std::span<const std::size_t> rows,
                             std::span<const Vector3d> tips_mm) {
  std::vector<Vector3d> taken;
  for (const std::size_t row : rows) taken.push_back(tips_mm[row]);
  TRY(auto out, chart_of_tips(result, taken));
  out.tips_mm = std::move(taken);
  out.cloud.outside = result.feature.side == record::Side::kOutside;
  out.cloud.passes = passes_of(result.cloud);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.cloud.points[i].repeats = result.cloud[rows[i]].repeats;
  }
  return out;
}

std::vector<TouchedPoint> touched_points(const Chart& chart, const Vector3d& middle_mm) {
  std::vector<TouchedPoint> out;
  for (std::size_t i = 0; i < chart.normals.size(); ++i) {
    const FormPoint& point = chart.cloud.points[i];
    const Vector3d& normal = chart.normals[i];
    const double from_middle = normal.dot(chart.tips_mm[i] - middle_mm);
    out.push_back({chart.tips_mm[i], normal, chart.cloud.outside ? Vector3d(-normal) : normal,
                   from_middle, from_middle, point.repeats, point.pose, point.time_1});
  }
  return out;
}

}  // namespace rondure::evaluation
