#include "evaluation/factors/internal/outliers.h"

#include <cmath>
#include <utility>

#include "evaluation/part/outliers.h"
#include "fit/geometry/axis.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"

namespace rondure::evaluation {
namespace {

using record::Form;

constexpr double kSigmas = 3.0;

/// Marks the deviations that a rule calls outliers.
/// @param parameters  Number of parameters of the least-squares fit that the deviations come from.
std::vector<bool> flagged(const std::vector<double>& deviations, OutlierRule rule,
                          double parameters) {
  if (rule == OutlierRule::kFiveMedians) return beyond_five_scales(deviations);
  double squares = 0.0;
  for (const double d : deviations) squares += d * d;
  const double freedoms = static_cast<double>(deviations.size()) - parameters;
  const double limit = freedoms > 0.0 ? kSigmas * std::sqrt(squares / freedoms) : squares + 1.0;
  std::vector<bool> out;
  for (const double d : deviations) out.push_back(std::abs(d) > limit);
  return out;
}

/// Distances from the least-squares circle of a section.
core::Result<std::vector<double>> section_deviations(const Points3& points) {
  const auto plane = across_axis(points);
  TRY(const auto circle, fit::ls_circle(plane));
  std::vector<double> out;
  for (const Eigen::Vector2d& p : plane)
    out.push_back((p - circle.center_mm).norm() - circle.radius_mm);
  return out;
}

core::Result<std::vector<double>> cylinder_deviations(const Points3& points) {
  TRY(const auto cylinder, fit::ls_cylinder(points, Eigen::Vector3d::UnitZ()));
  std::vector<double> out;
  for (const Eigen::Vector3d& p : points)
    out.push_back(fit::distance_mm(cylinder.axis, p) - cylinder.radius_mm);
  return out;
}

/// The outlier flags of all points, layer by layer.
core::Result<std::vector<bool>> outliers_of(const FactorPoints& points, OutlierRule rule) {
  if (points.form == Form::kCylindricity) {
    TRY(const auto deviations, cylinder_deviations(points.all_mm()));
    auto out = flagged(deviations, rule, 5.0);
    TRY_DO(count_of_outliers(out));
    return out;
  }
  std::vector<bool> out;
  for (const Points3& layer : points.layers_mm) {
    TRY(const auto deviations, section_deviations(layer));
    const auto of_layer = flagged(deviations, rule, 3.0);
    TRY_DO(count_of_outliers(of_layer));
    out.insert(out.end(), of_layer.begin(), of_layer.end());
  }
  return out;
}

}  // namespace

core::Result<WithoutOutliers> without_outliers(const FactorPoints& points, OutlierRule rule) {
  if (rule == OutlierRule::kNone) return WithoutOutliers{points, 0};
  TRY(const auto out_of_all, outliers_of(points, rule));
  WithoutOutliers out{{points.form, points.layers_known, {}}, 0};
  std::size_t row = 0;
  for (const Points3& layer : points.layers_mm) {
    Points3 kept;
    for (const Eigen::Vector3d& p : layer) {
      if (!out_of_all[row++]) kept.push_back(p);
    }
    out.left_out += layer.size() - kept.size();
    if (!kept.empty()) out.points.layers_mm.push_back(std::move(kept));
  }
  return out;
}

}  // namespace rondure::evaluation
