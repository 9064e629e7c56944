#include "evaluation/factors/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <variant>

#include <Eigen/LU>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/profiles/roundness.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"

namespace rondure::evaluation {
namespace {

using record::Form;
using record::Reference;

constexpr double kPointsPerUndulation = 7.0;

/// Plane of a layer: its height over the angle, z = a + b cos + c sin.
Eigen::Vector3d plane_heights(const Points3& points, const Eigen::Vector2d& center) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const double first = points.front().z();
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d n = (p.head<2>() - center).normalized();
    const Eigen::Vector3d row(1.0, n.x(), n.y());
    normal += row * row.transpose();
    right += row * (p.z() - first);
  }
  return normal.inverse() * right + Eigen::Vector3d(first, 0.0, 0.0);
}

core::Result<Points3> filtered_layer(const Points3& points, double cutoff_upr) {
  const auto needed = static_cast<std::size_t>(std::ceil(kPointsPerUndulation * cutoff_upr));
  if (points.size() < needed) {
    return core::fail_with(core::Code::kSampling, "needs {} points a layer, has {}", needed,
                           points.size());
  }
  const auto plane = across_axis(points);
  TRY(const auto circle, fit::ls_circle(plane));
  fit::RoundnessOptions options;
  options.filter.cutoff_upr = cutoff_upr;
  options.references = {};
  options.highest_harmonic = 0;
  TRY(const auto section, fit::evaluate_section(plane, options));
  const Eigen::Vector3d heights = plane_heights(points, circle.center_mm);
  Points3 out;
  out.reserve(section.r_mm.size());
  for (std::size_t i = 0; i < section.r_mm.size(); ++i) {
    const Eigen::Vector2d n(std::cos(section.theta_rad[i]), std::sin(section.theta_rad[i]));
    const Eigen::Vector2d p = circle.center_mm + (circle.radius_mm + section.r_mm[i]) * n;
    out.emplace_back(p.x(), p.y(), heights.dot(Eigen::Vector3d(1.0, n.x(), n.y())));
  }
  return out;
}

template <class Fit>
core::Result<double> one_sided(const core::Result<Fit>& fit) {
  if (!fit) return core::fail(fit.error());
  return fit->deviation_mm;
}

core::Result<double> cylindricity(const Points3& points, Reference reference) {
  if (points.size() < 6) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points prove nothing: any 5 lie on a cylinder", points.size());
  }
  const Eigen::Vector3d near = Eigen::Vector3d::UnitZ();
  if (reference == Reference::kLeastSquares) return one_sided(fit::ls_cylinder(points, near));
  if (reference == Reference::kMinimumCircumscribed)
    return one_sided(fit::min_circumscribed_cylinder(points, near));
  if (reference == Reference::kMaximumInscribed)
    return one_sided(fit::max_inscribed_cylinder(points, near));
  TRY(const auto zone, fit::min_zone_cylinder(points, near));
  return zone.width_mm();
}

core::Result<double> roundness(const Points3& points, Reference reference) {
  if (points.size() < 4) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points a layer prove nothing: any 3 lie on a circle", points.size());
  }
  const auto plane = across_axis(points);
  if (reference == Reference::kLeastSquares) return one_sided(fit::ls_circle(plane));
  if (reference == Reference::kMinimumCircumscribed)
    return one_sided(fit::min_circumscribed_circle(plane));
  if (reference == Reference::kMaximumInscribed)
    return one_sided(fit::max_inscribed_circle(plane, {.global = false, .search = {}}));
  fit::CenterProofOptions options;
  options.global = false;
  TRY(const auto zone, fit::min_zone_circle(plane, options));
  return zone.width_mm();
}

/// A point with its angle on its layer.
struct PlacedPoint {
  double angle_rad = 0.0;
  Eigen::Vector3d place_mm;
};

/// Sorts by angle from the first point. Half a step of margin keeps a neighbour just before the
/// first point from becoming the last.
void sort_by_angle(std::vector<PlacedPoint>& layer) {
  const double from =
      layer.front().angle_rad - 0.5 * core::kTwoPi / static_cast<double>(layer.size());
  for (PlacedPoint& one : layer) {
    one.angle_rad = std::fmod(one.angle_rad - from, core::kTwoPi);
    if (one.angle_rad < 0.0) one.angle_rad += core::kTwoPi;
  }
  std::stable_sort(layer.begin(), layer.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    return a.angle_rad < b.angle_rad;
  });
}

/// One section of points in a plane, sorted by angle about a centre.
FactorPoints section_of(std::span<const Eigen::Vector2d> points_mm,
                        const Eigen::Vector2d& center_mm) {
  std::vector<PlacedPoint> placed;
  for (const Eigen::Vector2d& p : points_mm) {
    const Eigen::Vector2d v = p - center_mm;
    placed.push_back({std::atan2(v.y(), v.x()), {v.x(), v.y(), 0.0}});
  }
  sort_by_angle(placed);
  FactorPoints out{Form::kRoundness, true, {{}}};
  for (const PlacedPoint& one : placed) out.layers_mm.front().push_back(one.place_mm);
  return out;
}

core::Result<FactorPoints> analysis_points(const WheelResult& found) {
  return section_of(found.points_mm, found.evaluation.wheel.center_mm);
}

core::Result<FactorPoints> analysis_points(const SpindleResult& found) {
  // A shift e of the centre changes the deviations by e^2 / 2R: below 1e-6 um for e = 1 um.
  constexpr double kRadius_mm = 1000.0;
  const fit::UniformProfile& profile = found.separation.profile;
  std::vector<Eigen::Vector2d> points;
  points.reserve(profile.r_mm.size());
  for (std::size_t i = 0; i < profile.r_mm.size(); ++i) {
    const double angle = profile.angle_rad(i);
    points.emplace_back((kRadius_mm + profile.r_mm[i]) *
                        Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  FactorPoints out = section_of(points, Eigen::Vector2d::Zero());
  const fit::FilterOptions& filter = found.roundness.filter;
  if (filter.filter != fit::ProfileFilter::kNone) out.reported_upr = filter.cutoff_upr;
  return out;
}

core::Result<FactorPoints> analysis_points(const ContourResult&) {
  return core::fail(core::Code::kNoPoints, "a contour is no section of points");
}

core::Result<FactorPoints> analysis_points(const RotaryResult&) {
  return core::fail(core::Code::kNoPoints, "balls of a fixture are no section of points");
}

core::Result<FactorPoints> analysis_points(const FiveAxisResult&) {
  return core::fail(core::Code::kNoPoints, "balls of a head are no section of points");
}

bool keeps(PointSubset subset, std::size_t layer, std::size_t layers, std::size_t point) {
  switch (subset) {
    case PointSubset::kAll:
      return true;
    case PointSubset::kEvenPoints:
      return point % 2 == 0;
    case PointSubset::kOddPoints:
      return point % 2 == 1;
    case PointSubset::kEvenLayers:
      return layer % 2 == 0;
    case PointSubset::kOddLayers:
      return layer % 2 == 1;
    case PointSubset::kWithoutFirstLayer:
      return layer != 0;
    case PointSubset::kWithoutLastLayer:
      return layer + 1 != layers;
  }
  return true;
}

}  // namespace

std::vector<Eigen::Vector2d> across_axis(const Points3& points_mm) {
  std::vector<Eigen::Vector2d> out;
  out.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) out.emplace_back(p.head<2>());
  return out;
}

std::size_t FactorPoints::count() const {
  std::size_t out = 0;
  for (const Points3& layer : layers_mm) out += layer.size();
  return out;
}

Points3 FactorPoints::all_mm() const {
  Points3 out;
  out.reserve(count());
  for (const Points3& layer : layers_mm) out.insert(out.end(), layer.begin(), layer.end());
  return out;
}

core::Result<FactorPoints> factor_points(const FeatureResult& result, Form form) {
  if (result.failure) return core::fail(*result.failure);
  if (result.analysis) {
    return std::visit([](const auto& found) { return analysis_points(found); },
                      result.analysis->found);
  }
  FactorPoints out;
  out.form = form;
  out.layers_known = !result.layers.empty();
  if (form == Form::kRoundness && !out.layers_known)
    return core::fail(core::Code::kNoPoints, "this feature has no sections");
  const fit::Axis& axis = result.mz_cylinder ? result.mz_cylinder->axis : result.section_axis;
  const auto frame = fit::across(axis.direction);
  std::map<int, std::vector<PlacedPoint>> layers;
  for (const CloudPoint& point : result.cloud) {
    const Eigen::Vector3d v = point.tip_mm - axis.point_mm;
    const Eigen::Vector2d in_plane = frame.transpose() * v;
    layers[out.layers_known ? point.layer : 0].push_back(
        {point.angle_rad, {in_plane.x(), in_plane.y(), axis.direction.dot(v)}});
  }
  for (auto& [number, layer] : layers) {
    if (out.layers_known) sort_by_angle(layer);
    Points3 places;
    places.reserve(layer.size());
    for (const PlacedPoint& one : layer) places.push_back(one.place_mm);
    out.layers_mm.push_back(std::move(places));
  }
  return out;
}

std::vector<PointSubset> subsets_of(const FactorPoints& points) {
  std::vector<PointSubset> out = {PointSubset::kAll, PointSubset::kEvenPoints,
                                  PointSubset::kOddPoints};
  if (points.layers_mm.size() < 2) return out;
  out.insert(out.end(), {PointSubset::kEvenLayers, PointSubset::kOddLayers,
                         PointSubset::kWithoutFirstLayer, PointSubset::kWithoutLastLayer});
  return out;
}

std::vector<double> cutoffs_of(const FactorPoints& points) {
  std::vector<double> out = {0.0, 15.0, 50.0, 150.0};
  if (std::ranges::find(out, points.reported_upr) == out.end()) {
    out.push_back(points.reported_upr);
    std::ranges::sort(out);
  }
  return out;
}

FactorPoints chosen(const FactorPoints& points, PointSubset subset) {
  FactorPoints out{points.form, points.layers_known, {}};
  const std::size_t layers = points.layers_mm.size();
  for (std::size_t layer = 0; layer < layers; ++layer) {
    Points3 kept;
    for (std::size_t i = 0; i < points.layers_mm[layer].size(); ++i) {
      if (keeps(subset, layer, layers, i)) kept.push_back(points.layers_mm[layer][i]);
    }
    if (!kept.empty()) out.layers_mm.push_back(std::move(kept));
  }
  return out;
}

core::Result<FactorPoints> filtered(const FactorPoints& points, double cutoff_upr) {
  if (!points.layers_known) {
    return core::fail(core::Code::kSampling, "the layers of the points are not known");
  }
  FactorPoints out{points.form, true, {}};
  for (const Points3& layer : points.layers_mm) {
    TRY(auto of_layer, filtered_layer(layer, cutoff_upr));
    out.layers_mm.push_back(std::move(of_layer));
  }
  return out;
}

core::Result<double> deviation_mm(const FactorPoints& points, Reference reference) {
  if (points.form == Form::kCylindricity) return cylindricity(points.all_mm(), reference);
  double worst = 0.0;
  for (const Points3& layer : points.layers_mm) {
    const auto of_layer = roundness(layer, reference);
    if (!of_layer) return of_layer;
    worst = std::max(worst, *of_layer);
  }
  if (points.layers_mm.empty()) return core::fail(core::Code::kNoPoints, "no points are left");
  return worst;
}

}  // namespace rondure::evaluation
