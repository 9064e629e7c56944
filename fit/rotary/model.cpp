#include "fit/rotary/model.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"
#include "core/units.h"

namespace rondure::fit {
namespace {

using core::Code;

/// Basis of a least-squares curve at an angle counted from the middle of the stations.
Eigen::VectorXd basis_of(RotaryCurve curve, std::size_t stations, double angle_rad,
                         double half_span_rad) {
  if (curve == RotaryCurve::kFourier) {
    const auto order = static_cast<Eigen::Index>(stations / 3);
    Eigen::VectorXd out(2 * order + 1);
    out(0) = 1.0;
    for (Eigen::Index k = 1; k <= order; ++k) {
      out(2 * k - 1) = std::cos(static_cast<double>(k) * angle_rad);
      out(2 * k) = std::sin(static_cast<double>(k) * angle_rad);
    }
    return out;
  }
  const auto degree = static_cast<Eigen::Index>(std::min<std::size_t>(4, (stations - 1) / 3));
  Eigen::VectorXd out(degree + 3);
  out(0) = std::cos(angle_rad);
  out(1) = std::sin(angle_rad);
  for (Eigen::Index k = 0; k <= degree; ++k) {
    out(2 + k) = std::pow(angle_rad / half_span_rad, static_cast<double>(k));
  }
  return out;
}

core::Result<void> check_curve(const RotaryTable& table) {
  if (table.curve == RotaryCurve::kFourier && !table.full_circle) {
    return core::fail(Code::kBadOption,
                      "a Fourier series needs stations all round the circle; take a spline or a "
                      "polynomial for an arc");
  }
  if (table.curve == RotaryCurve::kPolynomial && table.full_circle) {
    return core::fail(Code::kBadOption,
                      "a polynomial does not close on a full circle; take a spline or a Fourier "
                      "series");
  }
  const std::size_t least = table.curve == RotaryCurve::kSpline && table.full_circle ? 3 : 4;
  if (table.rows.size() < least) {
    return core::fail_with(Code::kTooFewPoints,
                           "{} determined stations, at least {} are needed for errors between them",
                           table.rows.size(), least);
  }
  return {};
}

core::Result<void> check_rows(const RotaryTable& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const RotaryTableRow& row = table.rows[i];
    if (!std::isfinite(row.angle_rad) || !row.errors.allFinite() || !row.covariance.allFinite()) {
      return core::fail_with(Code::kNotFinite, "row {} of the error table is not finite", i + 1);
    }
    if (i > 0 && !(row.angle_rad > table.rows[i - 1].angle_rad + 1e-9)) {
      return core::fail_with(
          Code::kTable, "row {} of the error table, {:g} deg, does not follow on {:g} deg", i + 1,
          row.angle_rad / core::kDegree, table.rows[i - 1].angle_rad / core::kDegree);
    }
  }
  const double span = table.rows.back().angle_rad - table.rows.front().angle_rad;
  if (table.full_circle && span > core::kTwoPi - 1e-9) {
    return core::fail_with(Code::kTable,
                           "the rows of a full circle span {:g} deg, less than 360 is expected",
                           span / core::kDegree);
  }
  return {};
}

}  // namespace

core::Result<RotaryModel> RotaryModel::of(RotaryTable table) {
  TRY_DO(check_curve(table));
  TRY_DO(check_rows(table));
  RotaryModel out;
  out.table_ = std::move(table);
  if (out.table_.curve == RotaryCurve::kSpline) {
    out.make_splines();
  } else {
    out.make_least_squares();
  }
  return out;
}

void RotaryModel::make_splines() {
  const std::size_t n = table_.rows.size();
  std::vector<double> x;
  for (const RotaryTableRow& row : table_.rows) x.push_back(row.angle_rad - lowest_rad());
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> unit(n, 0.0);
    unit[i] = 1.0;
    if (table_.full_circle) {
      circle_.emplace_back(x, std::move(unit));
    } else {
      arc_.emplace_back(x, std::move(unit));
    }
  }
}

void RotaryModel::make_least_squares() {
  const auto n = static_cast<Eigen::Index>(table_.rows.size());
  const double middle = 0.5 * (lowest_rad() + highest_rad());
  const double half = 0.5 * (highest_rad() - lowest_rad());
  Eigen::MatrixXd rows;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto b = basis_of(table_.curve, table_.rows.size(),
                            table_.rows[static_cast<std::size_t>(i)].angle_rad - middle, half);
    rows.conservativeResize(n, b.size());
    rows.row(i) = b.transpose();
  }
  for (Eigen::Index error = 0; error < 6; ++error) {
    Eigen::VectorXd root(n);  // square roots of the weights
    for (Eigen::Index i = 0; i < n; ++i) {
      const double variance = table_.rows[static_cast<std::size_t>(i)].covariance(error, error);
      root(i) = variance > 0.0 ? 1.0 / std::sqrt(variance) : 1.0;
    }
    root /= root.maxCoeff();
    const Eigen::MatrixXd weighted = root.asDiagonal() * rows;
    fit_.push_back(core::solve_pivoted_qr(weighted, Eigen::MatrixXd(root.asDiagonal())));
  }
}

RotaryModel::Weights RotaryModel::weights_at(double angle_rad) const {
  const auto n = static_cast<Eigen::Index>(table_.rows.size());
  Weights out(n, 6);
  if (table_.curve == RotaryCurve::kSpline) {
    const double x = angle_rad - lowest_rad();
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      out.row(i).setConstant(table_.full_circle ? circle_[k](x) : arc_[k](x).value);
    }
    return out;
  }
  const double middle = 0.5 * (lowest_rad() + highest_rad());
  const auto b = basis_of(table_.curve, table_.rows.size(), angle_rad - middle,
                          0.5 * (highest_rad() - lowest_rad()));
  for (Eigen::Index error = 0; error < 6; ++error) {
    out.col(error) = fit_[static_cast<std::size_t>(error)].transpose() * b;
  }
  return out;
}

bool RotaryModel::bridged_at(double angle_rad) const {
  const auto& rows = table_.rows;
  const auto above = std::ranges::find_if(
      rows, [&](const RotaryTableRow& row) { return row.angle_rad >= angle_rad - 1e-12; });
  if (above != rows.end() && std::abs(above->angle_rad - angle_rad) <= 1e-12) return false;
  const bool around = above == rows.begin() || above == rows.end();  // across the seam of a circle
  const double low = above == rows.begin() ? highest_rad() - core::kTwoPi : (above - 1)->angle_rad;
  const double high = above == rows.end() ? lowest_rad() + core::kTwoPi : above->angle_rad;
  return std::ranges::any_of(table_.missing_rad, [&](double missing) {
    for (const double turn : {-core::kTwoPi, 0.0, core::kTwoPi}) {
      if (missing + turn > low && missing + turn < high && (around || turn == 0.0)) return true;
    }
    return false;
  });
}

core::Result<double> RotaryModel::within(double angle_rad) const {
  if (!std::isfinite(angle_rad)) return core::fail(Code::kNotFinite, "the angle is not finite");
  if (table_.full_circle) {
    const double turns = std::floor((angle_rad - lowest_rad()) / core::kTwoPi);
    const double x = angle_rad - lowest_rad() - turns * core::kTwoPi;
    return lowest_rad() + std::clamp(x, 0.0, core::kTwoPi);
  }
  constexpr double kRoundOff = 1e-9;
  if (angle_rad < lowest_rad() - kRoundOff || angle_rad > highest_rad() + kRoundOff) {
    return core::fail_with(
        Code::kOutOfRange,
        "{:.4f} deg is outside the calibrated stations {:g}..{:g} deg; errors are not extrapolated",
        angle_rad / core::kDegree, lowest_rad() / core::kDegree, highest_rad() / core::kDegree);
  }
  return std::clamp(angle_rad, lowest_rad(), highest_rad());
}

core::Result<RotaryErrors> RotaryModel::at(double angle_rad) const {
  TRY(const auto angle, within(angle_rad));
  const Weights weights = weights_at(angle);
  Vector6 sum = Vector6::Zero();
  RotaryErrors out;
  for (std::size_t i = 0; i < table_.rows.size(); ++i) {
    const Vector6 w = weights.row(static_cast<Eigen::Index>(i)).transpose();
    sum += w.cwiseProduct(table_.rows[i].errors);
    out.covariance += w.asDiagonal() * table_.rows[i].covariance * w.asDiagonal();
  }
  out.t_mm = sum.head<3>();
  out.w_rad = sum.tail<3>();
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = table_.axis.turn(angle - table_.reference_rad);
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  out.covariance += turn * table_.reference_covariance * turn.transpose();
  out.covariance.diagonal() += table_.hysteresis_rms.cwiseAbs2();
  out.bridged = bridged_at(angle);
  return out;
}

core::Result<Eigen::Isometry3d> RotaryModel::motion(double angle_rad) const {
  TRY(const auto errors, at(angle_rad));
  return rotary_motion(table_.axis, angle_rad - table_.reference_rad, errors);
}

}  // namespace rondure::fit
