#include "fit/wheel/loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/decompositions.h"
#include "core/statistics.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

constexpr int kHighestOrder = 15;
constexpr double kMedianOfSquare = 0.4549;  ///< Of a normal variate of unit variance.
constexpr double kWorstShare = 4.0;         ///< Variance of a coefficient over that of even places.

}  // namespace

std::vector<double> found_amplitudes(PlanePoints points_mm, const Eigen::Vector2d& center_mm,
                                     double point_mm) {
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
  std::vector<double> squares;  // each that of a point, if it is noise
  for (Eigen::Index j = 3; j <= 2 * held; ++j) {
    squares.push_back(parts(j) * parts(j) / inverse(j, j));
  }
  const double noise =
      squares.empty()
          ? 0.0
          : std::min(point_mm * point_mm, core::upper_median(std::move(squares)) / kMedianOfSquare);
  std::vector<double> out;
  for (Eigen::Index k = 1; k <= held; ++k) {
    const double power = parts.segment<2>(2 * k - 1).squaredNorm();
    const double of_noise = noise * inverse.diagonal().segment<2>(2 * k - 1).sum();
    // Stein's estimate: noise alone leaves a quarter of what it reads.
    out.push_back(power > of_noise ? (power - of_noise) / std::sqrt(power) : 0.0);
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

double lobes_in_radius_mm(std::span<const double> angles_rad, std::span<const double> residuals_mm,
                          double point_mm) {
  constexpr double kLeastPoint_mm = 1e-7;
  constexpr int kSizes = 160;  // of lobes, over 16 decades of their power
  constexpr double kCoverage = 0.95;
  const auto n = static_cast<Eigen::Index>(angles_rad.size());
  Eigen::MatrixXd circle(n, 3);
  Eigen::MatrixXd lobes(n, 5);  // of orders 2 and 3, then the residuals
  for (Eigen::Index i = 0; i < n; ++i) {
    const double a = angles_rad[static_cast<std::size_t>(i)];
    circle.row(i) << std::cos(a), std::sin(a), 1.0;
    lobes.row(i) << std::cos(2.0 * a), std::sin(2.0 * a), std::cos(3.0 * a), std::sin(3.0 * a),
        residuals_mm[static_cast<std::size_t>(i)];
  }
  const Eigen::MatrixXd absorbed = core::solve_pivoted_qr(circle, lobes);
  const double per_lobe = absorbed.row(2).head<4>().norm();
  const Eigen::MatrixXd seen = lobes - circle * absorbed;
  const Eigen::Matrix4d squares = seen.leftCols<4>().transpose() * seen.leftCols<4>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> modes(squares);
  const Eigen::Vector4d along =
      modes.eigenvectors().transpose() * (seen.leftCols<4>().transpose() * seen.col(4));
  // Form that no such lobe explains counts as noise.
  Eigen::MatrixXd columns(n, 7);
  columns << circle, lobes.leftCols<4>();
  const Eigen::VectorXd residuals = lobes.col(4);
  const Eigen::VectorXd other = residuals - columns * core::solve_pivoted_qr(columns, residuals);
  const double noise = std::max(std::pow(std::max(point_mm, kLeastPoint_mm), 2.0),
                                n > 7 ? other.squaredNorm() / static_cast<double>(n - 7) : 0.0);
  std::vector<double> sizes_mm;
  std::vector<double> logs;
  for (int j = 0; j < kSizes; ++j) {
    const double p = std::pow(10.0, -4.0 + 0.1 * j);
    double log = std::log(p) - 2.0 * std::log1p(p);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double power = modes.eigenvalues()(i);
      if (power <= 1e-12 * static_cast<double>(n)) continue;  // not seen at all
      const double variance = noise * (1.0 + (1.0 + p) * power);
      log -= 0.5 * (std::log(variance) + along(i) * along(i) / (power * variance));
    }
    sizes_mm.push_back(per_lobe * std::sqrt(noise * (1.0 + p)));
    logs.push_back(log);
  }
  const double greatest = *std::ranges::max_element(logs);
  const auto held = [&](double half_mm) {
    double inside = 0.0;
    double all = 0.0;
    for (std::size_t j = 0; j < logs.size(); ++j) {
      const double weight = std::exp(logs[j] - greatest);
      all += weight;
      inside += weight * std::erf(half_mm / (sizes_mm[j] * std::numbers::sqrt2));
    }
    return inside / all;
  };
  double low_mm = 0.0;
  double high_mm = 3.0 * sizes_mm.back();
  for (int step = 0; step < 60; ++step) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    (held(middle_mm) < kCoverage ? low_mm : high_mm) = middle_mm;
  }
  constexpr double kNormal95 = 1.959963985;
  return high_mm / kNormal95;
}

}  // namespace rondure::fit
