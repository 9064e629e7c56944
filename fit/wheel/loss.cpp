#include "fit/wheel/loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr int kHighestOrder = 15;
constexpr double kWorstShare = 4.0;  ///< Variance of a coefficient over that of even places.

}  // namespace

std::vector<double> found_amplitudes(PlanePoints points_mm, const Eigen::Vector2d& center_mm) {
  const auto n = static_cast<Eigen::Index>(points_mm.size());
  const auto count = static_cast<double>(n);
  const int highest = std::min(kHighestOrder, static_cast<int>((n - 1) / 2));
  if (highest < 1) return {};
  Eigen::MatrixXd columns(n, 2 * highest + 1);
  Eigen::VectorXd distances(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d v = points_mm[static_cast<std::size_t>(i)] - center_mm;
    distances(i) = v.norm();
    const double angle = std::atan2(v.y(), v.x());
    columns(i, 0) = 1.0;
    for (int k = 1; k <= highest; ++k) {
      columns(i, 2 * k - 1) = std::cos(k * angle);
      columns(i, 2 * k) = std::sin(k * angle);
    }
  }
  distances.array() -= distances.mean();  // of a radius of 50 mm the sums would lose digits
  Eigen::MatrixXd inverse;
  int held = 0;
  for (int k = 1; k <= highest; ++k) {
    const auto used = columns.leftCols(2 * k + 1);
    const Eigen::FullPivLU<Eigen::MatrixXd> normal(used.transpose() * used);
    if (!normal.isInvertible()) break;
    const Eigen::MatrixXd found = normal.inverse();
    if (!(found.diagonal().tail(2 * k).maxCoeff() <= kWorstShare * 2.0 / count)) break;
    inverse = found;
    held = k;
  }
  if (held == 0) return {};
  const Eigen::VectorXd parts = inverse * (columns.leftCols(2 * held + 1).transpose() * distances);
  std::vector<double> out;
  for (Eigen::Index k = 1; k <= held; ++k) {
    out.push_back(std::hypot(parts(2 * k - 1), parts(2 * k)));
  }
  return out;
}

double loss_in_gap_mm(double gap_rad, std::span<const double> amplitudes_mm, int first_order) {
  double out = 0.0;
  for (std::size_t i = 0; i < amplitudes_mm.size(); ++i) {
    const int order = static_cast<int>(i) + 1;
    if (order < first_order) continue;
    const double half = std::min(0.5 * order * gap_rad, std::numbers::pi);
    out += 2.0 * amplitudes_mm[i] * (1.0 - std::cos(half));
  }
  return out;
}

}  // namespace rondure::fit
