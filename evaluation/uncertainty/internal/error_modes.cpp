#include "evaluation/uncertainty/internal/error_modes.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double draw_one(Distribution distribution, core::KeyedNoise& noise) {
  if (distribution == Distribution::kNormal) return noise.normal();
  return std::sqrt(3.0) * (2.0 * noise.uniform() - 1.0);
}

/// Removes motions of the whole part from the columns; remainders at rounding level become zero.
void keep_form(const Eigen::MatrixXd& rigid, std::vector<VectorXd>& columns) {
  for (VectorXd& column : columns) {
    const double before = column.norm();
    column -= rigid * (rigid.transpose() * column);
    column -= rigid * (rigid.transpose() * column);
    if (column.norm() <= 1e-12 * before) column.setZero();
  }
}

}  // namespace

VectorXd drawn_coefficients(const DeclaredModes& declared, core::KeyedNoise& noise) {
  VectorXd out(static_cast<Index>(declared.columns.size()));
  for (const ErrorMode& mode : declared.modes) {
    if (mode.distribution == Distribution::kPhase) {
      const double phase = core::kTwoPi * noise.uniform();
      out[mode.column] = std::sqrt(2.0) * std::cos(phase);
      out[mode.column + 1] = std::sqrt(2.0) * std::sin(phase);
    } else {
      out[mode.column] = draw_one(mode.distribution, noise);
    }
  }
  return out;
}

ErrorModel::ErrorModel(const FormCloud& cloud, const Influences& influences)
    : ErrorModel(touched_points(cloud), rigid_basis(cloud), influences) {}

ErrorModel::ErrorModel(std::span<const TouchedPoint> points, const Eigen::MatrixXd& rigid,
                       const Influences& influences) {
  DeclaredModes declared = declared_modes(points, influences);
  keep_form(rigid, declared.columns);
  names_ = std::move(declared.names);
  point_errors_ = std::move(declared.point_errors);
  const Index n = static_cast<Index>(points.size());
  columns_.resize(n, static_cast<Index>(declared.columns.size()));
  for (Index k = 0; k < columns_.cols(); ++k) {
    columns_.col(k) = declared.columns[static_cast<std::size_t>(k)];
  }
  for (const ErrorMode& mode : declared.modes) {
    const Index width = mode.distribution == Distribution::kPhase ? 2 : 1;
    if (!columns_.middleCols(mode.column, width).isZero(0.0)) modes_.push_back(mode);
  }
  point_variance_ = VectorXd::Zero(n);
  double doubt = 0.0;  // squared uncertainty of the variance
  for (const PointError& error : point_errors_) {
    const VectorXd variance = error.sigma_mm.cwiseAbs2();
    point_variance_ += variance;
    if (error.degrees_of_freedom > 0.0) {
      doubt += variance.mean() * variance.mean() / error.degrees_of_freedom;
    }
  }
  if (doubt > 0.0) {
    degrees_of_freedom_ = point_variance_.mean() * point_variance_.mean() / doubt;
  }
  if (influences.probe) correlation_mm_ = influences.probe->correlation_length_mm;
}

bool ErrorModel::acts(std::size_t influence) const {
  const auto of_it = [&](const auto& error) { return error.influence == influence; };
  return std::any_of(modes_.begin(), modes_.end(), of_it) ||
         std::any_of(point_errors_.begin(), point_errors_.end(), of_it);
}

void ErrorModel::draw(core::KeyedNoise& noise, const std::optional<std::size_t>& only,
                      VectorXd& errors_mm) const {
  errors_mm.setZero(point_variance_.size());
  for (const ErrorMode& mode : modes_) {
    if (only && mode.influence != *only) continue;
    if (mode.distribution == Distribution::kPhase) {
      const double phase = core::kTwoPi * noise.uniform();
      errors_mm += std::sqrt(2.0) * std::cos(phase) * columns_.col(mode.column) +
                   std::sqrt(2.0) * std::sin(phase) * columns_.col(mode.column + 1);
    } else {
      errors_mm += draw_one(mode.distribution, noise) * columns_.col(mode.column);
    }
  }
  for (const PointError& error : point_errors_) {
    if (only && error.influence != *only) continue;
    double before = 0.0;
    for (Index i = 0; i < errors_mm.size(); ++i) {
      double now = draw_one(error.distribution, noise);
      if (error.likeness_1.size() > 0) {
        const double like = error.likeness_1[i];
        now = like * before + std::sqrt(1.0 - like * like) * now;
      }
      errors_mm[i] += error.sigma_mm[i] * now;
      before = now;
    }
  }
}

}  // namespace rondure::evaluation
