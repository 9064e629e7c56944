#include "evaluation/uncertainty/angular_curve.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"

namespace rondure::evaluation {
namespace {

constexpr Eigen::Index kMostColumns = 61;  ///< Up to order 30; what is left has no order.
constexpr double kLeastError = 1e-9;       ///< mm; an error of 0 leaves no distribution.

/// Octaves of the orders: 0 to 7, 8 to 15, 16 to 30; then the columns without an order.
int group_of(std::size_t column) {
  if (static_cast<Eigen::Index>(column) >= kMostColumns) return 3;
  const std::size_t order = (column + 1) / 2;
  return order < 8 ? 0 : order < 16 ? 1 : 2;
}

}  // namespace

AngularCurve::AngularCurve(std::span<const double> angles_rad) {
  const auto n = static_cast<Eigen::Index>(angles_rad.size());
  Eigen::MatrixXd basis(n, std::min(n, kMostColumns));
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = angles_rad[static_cast<std::size_t>(i)];
    basis(i, 0) = 1.0;
    for (Eigen::Index j = 1; j < basis.cols(); ++j) {
      const auto order = static_cast<double>((j + 1) / 2);
      basis(i, j) = j % 2 == 1 ? std::cos(order * angle) : std::sin(order * angle);
    }
  }
  // Householder columns stay orthonormal also where an arc hardly tells the orders apart.
  columns_.compute(basis);
}

Eigen::VectorXd AngularCurve::coefficients(const Eigen::VectorXd& values) const {
  return core::q_transposed_times(columns_, values);
}

Eigen::VectorXd AngularCurve::values(const Eigen::VectorXd& coefficients) const {
  return core::q_times(columns_, coefficients);
}

MeasuredCurve AngularCurve::measured(const Eigen::VectorXd& coefficients, double u,
                                     std::size_t always) const {
  const auto n = static_cast<std::size_t>(coefficients.size());
  MeasuredCurve out;
  out.found_mm.assign(coefficients.begin(), coefficients.end());
  out.u_mm.assign(n, std::max(u, kLeastError));
  const bool all = n < 4 * always;
  for (std::size_t j = 0; j < n; ++j) {
    // Columns over scattered angles are judged alone: parts of one order are not parts of one wave
    // there, and two lobes among six orders would make the whole octave their core.
    out.group.push_back(group_of(j));
    out.always_core.push_back(all || j < always);
  }
  return out;
}

}  // namespace rondure::evaluation
