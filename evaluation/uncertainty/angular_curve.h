#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {

/// Values at angles as a curve: its coefficients in orthonormal columns over the angles, mean,
/// cosine and sine of the orders up to 30, then what these leave. A smooth curve has few of them,
/// noise the same in each.
class AngularCurve {
 public:
  /// @param angles_rad  At least one, of any spacing, on the whole turn or an arc.
  explicit AngularCurve(std::span<const double> angles_rad);

  [[nodiscard]] Eigen::VectorXd coefficients(const Eigen::VectorXd& values) const;
  [[nodiscard]] Eigen::VectorXd values(const Eigen::VectorXd& coefficients) const;

  /// The curve for CurveDraws, in octaves of orders.
  /// @param u       Standard uncertainty of every value; less than 1e-9 counts as that.
  /// @param always  The first coefficients, which belong to the core. Of fewer than 4 times as many
  ///                values they are more than a quarter of all: what stands out decides for the
  ///                whole curve.
  [[nodiscard]] MeasuredCurve measured(const Eigen::VectorXd& coefficients, double u,
                                       std::size_t always) const;

 private:
  Eigen::HouseholderQR<Eigen::MatrixXd> columns_;
};

}  // namespace rondure::evaluation
