#include "reports/form_draw.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"

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

/// The frame in which form, of covariance s^2 * form, and errors are both independent: form has the
/// variance s^2 there, the errors `noise`.
struct WhiteFrame {
  WhiteFrame(const MatrixXd& form, const MatrixXd& errors) {
    const Eigen::LLT<MatrixXd> cholesky(form);
    const MatrixXd lower = cholesky.matrixL();
    const auto solver = lower.triangularView<Eigen::Lower>();
    const MatrixXd half = solver.solve(errors);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> split(solver.solve(half.transpose()));
    noise = split.eigenvalues();
    const double largest = noise.size() > 0 ? noise.maxCoeff() : 0.0;
    for (double& value : noise) {
      if (value < 1e-14 * largest) value = 0.0;  // rounding
    }
    whiten = solver.solve(MatrixXd::Identity(form.rows(), form.rows()));
    whiten = split.eigenvectors().transpose() * whiten;
    color = lower * split.eigenvectors();
  }

  VectorXd noise;
  MatrixXd whiten;
  MatrixXd color;  ///< Its inverse.
};

/// Low undulations and degrees, each column one term; together they have the variance 1 at a point,
/// as much as what is independent from point to point.
MatrixXd smooth_form(const FormCloud& cloud) {
  FormSpectrum spectrum;
  const bool section = cloud.kind == FormKind::kRoundness;
  spectrum.low_mm = spectrum.high_mm = cloud.points.front().height_mm;
  for (const FormPoint& p : cloud.points) {
    spectrum.low_mm = std::min(spectrum.low_mm, p.height_mm);
    spectrum.high_mm = std::max(spectrum.high_mm, p.height_mm);
  }
  if (!section) spectrum.terms = {{0, 1, 0.5}, {0, 2, 0.5}, {1, 2, 0.5}};
  for (int p = 2; p <= 5; ++p) {
    for (int degree = 0; degree <= (section ? 0 : 2); ++degree) {
      spectrum.terms.push_back({p, degree, std::pow(0.5, degree) / std::sqrt(p)});
    }
  }
  const MatrixXd columns = spectrum_columns(spectrum, cloud.points);
  return columns / std::sqrt(columns.squaredNorm() / static_cast<double>(columns.rows()));
}

}  // namespace

SampledForm::SampledForm(const FormCloud& cloud, const ErrorModel& errors)
    : rigid_(rigid_basis(cloud)), point_variance_(errors.point_variance_mm2().mean()), size_(0.0) {
  MatrixXd smooth = smooth_form(cloud);
  smooth -= rigid_ * (rigid_.transpose() * smooth);
  solve(smooth, errors.columns());
  const VectorXd measured =
      deviations_of(cloud, spread_rows(cloud.points.size(), cloud.points.size()));
  deviations_ = whiten_ * measured;
  rest_ = beside(measured);
  std::vector<NoiseLevel> levels;
  for (Index k = 0; k < noise_.size(); ++k) {
    levels.push_back({noise_[k], deviations_[k] * deviations_[k], 1.0});
  }
  const Index beside_them = measured.size() - rigid_.cols() - directions_.cols();
  has_rest_ = beside_them > 0;
  if (has_rest_) {
    levels.push_back({point_variance_, rest_.squaredNorm(), static_cast<double>(beside_them)});
  }
  size_ = FormSize(levels);
}

void SampledForm::solve(const MatrixXd& smooth, const MatrixXd& systematic) {
  MatrixXd all(smooth.rows(), smooth.cols() + systematic.cols());
  all << smooth, systematic;
  for (Index k = 0; k < all.cols(); ++k) {
    const double length = all.col(k).norm();
    if (length > 0.0) all.col(k) /= length;
  }
  Eigen::ColPivHouseholderQR<MatrixXd> qr(all);
  qr.setThreshold(1e-6);
  const Index most = smooth.rows() - rigid_.cols();
  const Index rank = std::min(qr.rank(), most);
  directions_ = qr.householderQ() * MatrixXd::Identity(smooth.rows(), rank);
  const MatrixXd form = directions_.transpose() * smooth;
  const MatrixXd errors = directions_.transpose() * systematic;
  const MatrixXd unit = MatrixXd::Identity(rank, rank);
  const WhiteFrame frame(form * form.transpose() + unit,
                         errors * errors.transpose() + point_variance_ * unit);
  noise_ = frame.noise;
  whiten_ = frame.whiten * directions_.transpose();
  color_ = directions_ * frame.color;
}

/// What values hold beside place, size and the directions.
VectorXd SampledForm::beside(const VectorXd& values) const {
  VectorXd out = values - rigid_ * (rigid_.transpose() * values);
  out -= directions_ * (directions_.transpose() * out);
  return out;
}

void SampledForm::draw(core::KeyedNoise& noise, double size, const VectorXd& errors_mm,
                       VectorXd& form_mm) const {
  VectorXd inside(noise_.size());
  normals(noise, inside);
  inside *= size;
  const VectorXd miss = deviations_ - inside - whiten_ * errors_mm;
  for (Index k = 0; k < inside.size(); ++k) {
    inside[k] += form_share(size * size, noise_[k]) * miss[k];
  }
  form_mm = color_ * inside;
  if (has_rest_) draw_rest(noise, size, errors_mm, form_mm);
}

void SampledForm::draw_rest(core::KeyedNoise& noise, double size, const VectorXd& errors_mm,
                            VectorXd& form_mm) const {
  VectorXd form(rest_.size());
  normals(noise, form);
  form *= size;
  // Of form + share (measured - form - errors), what lies beside the directions.
  const double share = form_share(size * size, point_variance_);
  form_mm += beside((1.0 - share) * form - share * errors_mm) + share * rest_;
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

void WholeForm::solve(const MatrixXd& free, const MatrixXd& sampled, const MatrixXd& errors) {
  const MatrixXd form = free.transpose() * sampled;
  const MatrixXd error = free.transpose() * errors;
  MatrixXd covariance = form * form.transpose();
  const double rest =
      kRestShare * std::sqrt(covariance.trace() / static_cast<double>(covariance.rows()));
  covariance.diagonal().array() += rest * rest;
  const WhiteFrame frame(covariance, error * error.transpose());
  noise_ = frame.noise;
  whiten_ = frame.whiten * free.transpose();
  spectrum_ = frame.whiten * form;
  rest_ = rest * frame.whiten;
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
