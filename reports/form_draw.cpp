#include "reports/form_draw.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace rondure::reports {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Form outside the spectrum, as a share of the rms of what is inside: no surface is made of a few
/// harmonics alone.
constexpr double kRestShare = 0.05;

VectorXd deviations_of(const FormCloud& cloud, const std::vector<std::size_t>& rows) {
  VectorXd out(static_cast<Index>(rows.size()));
  for (Index i = 0; i < out.size(); ++i) {
    out[i] = cloud.points[rows[static_cast<std::size_t>(i)]].deviation_mm;
  }
  return out;
}

std::vector<std::size_t> spread_rows(std::size_t count, std::size_t most) {
  const std::size_t kept = std::min(count, most);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < kept; ++i) rows.push_back(i * count / kept);
  return rows;
}

void normals(core::KeyedNoise& noise, VectorXd& out) {
  for (Index i = 0; i < out.size(); ++i) out[i] = noise.normal();
}

/// s^2 / (s^2 + noise): how much of a deviation is form. All of it where there is no noise.
double form_share(double size2, double noise2) {
  return noise2 == 0.0 ? 1.0 : size2 / (size2 + noise2);
}

}  // namespace

SampledForm::SampledForm(const FormCloud& cloud, const ErrorModel& errors)
    : rigid_(rigid_basis(cloud)), size_(0.0) {
  const auto rows = spread_rows(cloud.points.size(), cloud.points.size());
  deviations_ = deviations_of(cloud, rows);
  deviations_ -= rigid_ * (rigid_.transpose() * deviations_);
  point_variance_ = errors.point_variance_mm2().mean();
  const MatrixXd& columns = errors.columns();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(columns.transpose() * columns);
  const double largest = columns.cols() > 0 ? modes.eigenvalues().maxCoeff() : 0.0;
  std::vector<NoiseLevel> levels;
  Index kept = 0;
  while (kept < columns.cols() &&
         modes.eigenvalues()[columns.cols() - 1 - kept] > 1e-10 * largest) {
    ++kept;
  }
  systematic_ = columns * modes.eigenvectors().rightCols(kept);
  systematic_variance_ = modes.eigenvalues().tail(kept);
  double square = deviations_.squaredNorm();
  for (Index k = 0; k < kept; ++k) {
    systematic_.col(k) /= std::sqrt(systematic_variance_[k]);
    systematic_variance_[k] += point_variance_;
    const double along = systematic_.col(k).dot(deviations_);
    levels.push_back({systematic_variance_[k], along * along, 1.0});
    square -= along * along;
  }
  const Index rest = deviations_.size() - rigid_.cols() - kept;
  if (rest > 0) {
    levels.push_back({point_variance_, std::max(0.0, square), static_cast<double>(rest)});
  }
  size_ = FormSize(levels);
}

void SampledForm::draw(core::KeyedNoise& noise, double size, const VectorXd& errors_mm,
                       VectorXd& form_mm) const {
  form_mm.resize(deviations_.size());
  normals(noise, form_mm);
  form_mm *= size;
  VectorXd miss = -form_mm - errors_mm;
  miss -= rigid_ * (rigid_.transpose() * miss);
  miss += deviations_;
  form_mm -= rigid_ * (rigid_.transpose() * form_mm);
  const double size2 = size * size;
  const double share = form_share(size2, point_variance_);
  VectorXd along = systematic_.transpose() * miss;
  for (Index k = 0; k < along.size(); ++k) {
    along[k] *= form_share(size2, systematic_variance_[k]) - share;
  }
  form_mm += share * miss + systematic_ * along;
}

WholeForm::WholeForm(const FormCloud& cloud, const ErrorModel& errors, const FormSpectrum& spectrum)
    : rows_(spread_rows(cloud.points.size(), kMostPoints)),
      places_(whole_surface(spectrum, cloud.kind)),
      surface_(spectrum_columns(spectrum, places_)),
      size_(1.0) {
  FormCloud part = cloud;
  part.points.clear();
  for (const std::size_t row : rows_) part.points.push_back(cloud.points[row]);
  const Index n = static_cast<Index>(rows_.size());
  MatrixXd columns(n, errors.columns().cols() + n);
  columns.rightCols(n).setZero();
  for (Index i = 0; i < n; ++i) {
    const auto row = static_cast<Index>(rows_[static_cast<std::size_t>(i)]);
    columns.row(i).head(errors.columns().cols()) = errors.columns().row(row);
    columns(i, errors.columns().cols() + i) = std::sqrt(errors.point_variance_mm2()[row]);
  }
  const MatrixXd rigid = rigid_basis(part);
  const Eigen::HouseholderQR<MatrixXd> qr(rigid);
  const MatrixXd full = qr.householderQ() * MatrixXd::Identity(n, n);
  solve(full.rightCols(n - rigid.cols()), spectrum_columns(spectrum, part.points), columns);
  deviations_ = whiten_ * deviations_of(cloud, rows_);
  if (spectrum.absolute) return;
  std::vector<NoiseLevel> levels;
  for (Index k = 0; k < noise_.size(); ++k) {
    levels.push_back({noise_[k], deviations_[k] * deviations_[k], 1.0});
  }
  size_ = FormSize(levels);
}

/// Finds the frame in which form (variance 1 for size 1) and errors (noise_) are both independent.
void WholeForm::solve(const MatrixXd& free, const MatrixXd& sampled, const MatrixXd& errors) {
  const MatrixXd form = free.transpose() * sampled;
  MatrixXd covariance = form * form.transpose();
  const double rest =
      kRestShare * std::sqrt(covariance.trace() / static_cast<double>(covariance.rows()));
  covariance.diagonal().array() += rest * rest;
  const Eigen::LLT<MatrixXd> cholesky(covariance);
  const auto lower = cholesky.matrixL();
  const MatrixXd noise = lower.solve(MatrixXd(free.transpose() * errors));
  const Eigen::SelfAdjointEigenSolver<MatrixXd> split(noise * noise.transpose());
  const MatrixXd turn = split.eigenvectors().transpose();
  const MatrixXd inverse = lower.solve(MatrixXd::Identity(form.rows(), form.rows()));
  noise_ = split.eigenvalues().cwiseMax(0.0);
  const double largest = noise_.size() > 0 ? noise_.maxCoeff() : 0.0;
  for (double& value : noise_) {
    if (value < 1e-14 * largest) value = 0.0;  // rounding
  }
  whiten_ = turn * inverse * free.transpose();
  spectrum_ = turn * inverse * form;
  rest_ = rest * turn * inverse;
  coefficients_ = spectrum_.transpose();
}

void WholeForm::draw(core::KeyedNoise& noise, double size, const VectorXd& errors_mm,
                     VectorXd& form_mm) const {
  VectorXd sampled_errors(static_cast<Index>(rows_.size()));
  for (Index i = 0; i < sampled_errors.size(); ++i) {
    sampled_errors[i] = errors_mm[static_cast<Index>(rows_[static_cast<std::size_t>(i)])];
  }
  VectorXd coefficients(spectrum_.cols());
  normals(noise, coefficients);
  VectorXd rest(rest_.cols());
  normals(noise, rest);
  VectorXd miss = spectrum_ * coefficients;
  miss += rest_ * rest;
  miss *= -size;
  miss += deviations_;
  miss -= whiten_ * sampled_errors;
  for (Index k = 0; k < miss.size(); ++k) miss[k] *= form_share(size * size, noise_[k]);
  coefficients *= size;
  coefficients += coefficients_ * miss;
  form_mm = surface_ * coefficients;
}

}  // namespace rondure::reports
