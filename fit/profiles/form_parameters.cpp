#include "fit/profiles/form_parameters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "fit/geometry/points.h"

namespace rondure::fit {

FormParameters form_parameters(std::span<const double> deviations_mm,
                               std::span<const double> cells) {
  assert(!deviations_mm.empty() && (cells.empty() || cells.size() == deviations_mm.size()));
  const auto [low, high] = std::minmax_element(deviations_mm.begin(), deviations_mm.end());
  double squares = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < deviations_mm.size(); ++i) {
    const double cell = cells.empty() ? 1.0 : cells[i];
    squares += cell * deviations_mm[i] * deviations_mm[i];
    weights += cell;
  }
  return {*high - *low, *high, -*low, std::sqrt(squares / weights)};
}

core::Result<FormParameters> cylindricity_parameters(std::span<const Eigen::Vector3d> points_mm,
                                                     const Axis& axis, double radius_mm,
                                                     bool inside) {
  TRY_DO(check_points(points_mm));
  std::vector<double> deviations;
  deviations.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) {
    const double outward = distance_mm(axis, p) - radius_mm;
    deviations.push_back(inside ? -outward : outward);
  }
  return form_parameters(deviations);
}

core::Result<FormParameters> flatness_parameters(std::span<const Eigen::Vector3d> points_mm,
                                                 const Plane& plane) {
  TRY_DO(check_points(points_mm));
  std::vector<double> deviations;
  deviations.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) deviations.push_back(height_mm(plane, p));
  return form_parameters(deviations);
}

}  // namespace rondure::fit
