#include "fit/wheel/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "core/units.h"

namespace rondure::fit {

double AngularOrder::coverage_rad() const { return core::kTwoPi - largest_gap_rad; }

bool AngularOrder::closed() const { return largest_gap_rad <= 90.0 * core::kDegree * (1 + 1e-9); }

AngularOrder angular_order(PlanePoints points_mm, const Eigen::Vector2d& center_mm) {
  const std::size_t n = points_mm.size();
  std::vector<double> angles(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d v = points_mm[i] - center_mm;
    angles[i] = std::atan2(v.y(), v.x());
  }
  std::vector<std::size_t> rows(n);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::stable_sort(rows, {}, [&](std::size_t row) { return angles[row]; });
  AngularOrder out;
  std::size_t first = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = rows[k > 0 ? k - 1 : n - 1];
    const double gap = angles[rows[k]] - angles[before] + (k > 0 ? 0.0 : core::kTwoPi);
    if (gap <= out.largest_gap_rad) continue;
    out.largest_gap_rad = gap;
    first = k;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t place = (first + k) % n;
    out.rows.push_back(rows[place]);
    out.angles_rad.push_back(angles[rows[place]] + (place < first ? core::kTwoPi : 0.0));
  }
  return out;
}

bool AngularOrder::even() const {
  const double step = core::kTwoPi / static_cast<double>(rows.size());
  return closed() && largest_gap_rad <= 2.0 * step * (1.0 + 1e-9);
}

CircleFactors circle_factors(std::span<const double> angles_rad) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    const double angle = angles_rad[i];
    if (i > 0 && angle == angles_rad[i - 1]) continue;  // a row given twice says nothing new
    const Eigen::Vector3d row(std::cos(angle), std::sin(angle), 1.0);
    normal += row * row.transpose();
  }
  bool invertible = false;
  Eigen::Matrix3d inverse;
  normal.computeInverseWithCheck(inverse, invertible, 1e-14);
  if (!invertible) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {kInfinity, kInfinity};
  }
  return {std::sqrt(inverse(0, 0) + inverse(1, 1)), std::sqrt(inverse(2, 2))};
}

double correlation_time(std::span<const double> residuals, bool closed) {
  const std::size_t n = residuals.size();
  const double power =
      std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
  if (power == 0.0) return 1.0;
  double tau = 1.0;
  for (std::size_t lag = 1; lag < (closed ? n / 2 + 1 : n); ++lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i < (closed ? n : n - lag); ++i) {
      sum += residuals[i] * residuals[(i + lag) % n];
    }
    if (sum <= 0.0) break;
    tau += 2.0 * sum / power;
  }
  return tau;
}

}  // namespace rondure::fit
