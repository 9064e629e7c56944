#include "evaluation/rotary/internal/combined_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/decompositions.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "fit/geometry/registration.h"
#include "fit/rotary/errors.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kScales = 601;      // 100 in a decade
constexpr double kDecades = 3.0;  // of the scale, to either side of 1
constexpr double kLeast = 1e-6;   // of the largest singular value: a direction that moves no ball
constexpr double kLength_mm = 100.0;  // brings rotations to the size of shifts

/// Displacements of the balls of a pose by errors of one standard uncertainty, in independent
/// columns: rows of [I, -[p]x] times a root of the covariance.
MatrixXd displacements(const CombinedPose& pose) {
  fit::Matrix6 scaled = pose.covariance;
  scaled.bottomRows<3>() *= kLength_mm;
  scaled.rightCols<3>() *= kLength_mm;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> root{MatrixXd(scaled)};
  MatrixXd rows(3 * static_cast<Index>(pose.at_mm.size()), 6);
  for (std::size_t i = 0; i < pose.at_mm.size(); ++i) {
    rows.middleRows<3>(3 * static_cast<Index>(i)) << Eigen::Matrix3d::Identity(),
        -fit::cross_matrix(pose.at_mm[i]) / kLength_mm;
  }
  return rows * root.eigenvectors() * root.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

VectorXd stacked(const std::vector<Vector3d>& all) {
  VectorXd out(3 * static_cast<Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) out.segment<3>(3 * static_cast<Index>(i)) = all[i];
  return out;
}

}  // namespace

CombinedField::CombinedField(std::span<const CombinedPose> poses, double noise_mm)
    : noise_mm_(noise_mm) {
  for (const CombinedPose& pose : poses) {
    points_ += static_cast<double>(pose.at_mm.size());
    const MatrixXd columns = displacements(pose);
    // columns = U S V^T; the squares of S and V from the product of the columns.
    const Eigen::SelfAdjointEigenSolver<MatrixXd> product{MatrixXd(columns.transpose() * columns)};
    const double largest = std::sqrt(std::max(0.0, product.eigenvalues().maxCoeff()));
    const VectorXd residual = stacked(pose.residual_mm);
    Pose out;
    out.motions.resize(columns.rows(), 0);
    for (Index k = 0; k < 6; ++k) {
      const double size = std::sqrt(std::max(0.0, product.eigenvalues()(k)));
      if (!(size > kLeast * largest)) continue;
      const VectorXd motion = columns * product.eigenvectors().col(k);  // S times a column of U
      out.motions.conservativeResize(Eigen::NoChange, out.motions.cols() + 1);
      out.motions.rightCols<1>() = motion;
      out.found.push_back(motion.dot(residual) / (size * size));
      out.u.push_back(noise_mm / size);
    }
    poses_.push_back(std::move(out));
  }
  weigh_scales();
}

void CombinedField::weigh_scales() {
  std::vector<double> logs;
  for (int i = 0; i < kScales; ++i) {
    const double log_scale = std::log(10.0) * kDecades * (2.0 * i / (kScales - 1) - 1.0);
    const double scale = std::exp(log_scale);
    double sum = -0.5 * std::pow(log_scale / std::log(10.0), 2);
    for (const Pose& pose : poses_) {
      for (std::size_t k = 0; k < pose.found.size(); ++k) {
        const double variance = scale * scale + pose.u[k] * pose.u[k];
        sum -= 0.5 * (std::log(variance) + pose.found[k] * pose.found[k] / variance);
      }
    }
    scales_.push_back(scale);
    logs.push_back(sum);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double log : logs) cumulative_.push_back(sum += std::exp(log - most));
  for (double& share : cumulative_) share /= sum;
}

double CombinedField::scale_at(double probability) const {
  const auto at = std::lower_bound(cumulative_.begin(), cumulative_.end(), probability);
  if (at == cumulative_.end()) return scales_.back();
  return scales_[static_cast<std::size_t>(at - cumulative_.begin())];
}

CombinedField::Residual CombinedField::draw(std::uint64_t seed, int trial) const {
  const double uniform =
      0.5 + uniform_draw(seed, "fixture.combined.scale", 0, trial) / std::sqrt(12.0);
  const double scale2 = std::pow(scale_at(uniform), 2);
  Residual out;
  double squares = 0.0;
  std::uint64_t instance = 0;
  for (const Pose& pose : poses_) {
    VectorXd field = VectorXd::Zero(pose.motions.rows());
    for (std::size_t k = 0; k < pose.found.size(); ++k) {
      // The true coefficient, given the one that was found with noise.
      const double noise2 = pose.u[k] * pose.u[k];
      const double share = scale2 / (scale2 + noise2);
      const double true_1 = share * pose.found[k] +
                            std::sqrt(share * noise2) *
                                normal_draw(seed, "fixture.combined.motion", instance++, trial);
      field += true_1 * pose.motions.col(static_cast<Index>(k));
    }
    squares += field.squaredNorm();
    for (Index i = 0; i < field.size(); i += 3) {
      out.max_mm = std::max(out.max_mm, field.segment<3>(i).norm());
    }
  }
  out.rms_mm = std::sqrt(squares / std::max(1.0, points_));
  return out;
}

CombinedField::Residual CombinedField::per_noise() const {
  Residual out;
  // Noise along the field moves the rms of all points; only the rigid share of the noise of a ball
  // moves its prediction.
  out.rms_mm = noise_mm_ / std::sqrt(std::max(1.0, points_));
  double largest_mm = -1.0;
  for (const Pose& pose : poses_) {
    VectorXd field = VectorXd::Zero(pose.motions.rows());
    for (std::size_t k = 0; k < pose.found.size(); ++k) {
      field += pose.found[k] * pose.motions.col(static_cast<Index>(k));
    }
    for (Index i = 0; i < field.size(); i += 3) {
      const Vector3d at = field.segment<3>(i);
      if (at.norm() <= largest_mm) continue;
      largest_mm = at.norm();
      const Vector3d along = at.normalized();
      double leverage = 0.0;
      for (Index k = 0; k < pose.motions.cols(); ++k) {
        const VectorXd column = pose.motions.col(k);
        leverage += std::pow(column.segment<3>(i).dot(along), 2) / column.squaredNorm();
      }
      out.max_mm = noise_mm_ * std::sqrt(leverage);
    }
  }
  return out;
}

CombinedField::Residual moved_by(std::span<const CombinedPose> poses) {
  CombinedField::Residual out;
  double squares = 0.0;
  double points = 0.0;
  for (const CombinedPose& pose : poses) {
    std::vector<Vector3d> found;
    for (std::size_t i = 0; i < pose.at_mm.size(); ++i) {
      found.emplace_back(pose.at_mm[i] + pose.residual_mm[i]);
    }
    const auto moved = fit::rigid_registration(pose.at_mm, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Vector3d by = (moved ? moved->motion * pose.at_mm[i] : found[i]) - pose.at_mm[i];
      squares += by.squaredNorm();
      points += 1.0;
      out.max_mm = std::max(out.max_mm, by.norm());
    }
  }
  out.rms_mm = std::sqrt(squares / std::max(1.0, points));
  return out;
}

ResidualTrials residual_trials(std::span<const CombinedPose> poses, double noise_mm,
                               const UncertaintyOptions& options) {
  const CombinedField field(poses, noise_mm);
  const int trials = std::max(2000, options.least_trials);
  ResidualTrials out;
  for (int t = 0; t < trials; ++t) {
    const CombinedField::Residual drawn = field.draw(options.seed, t);
    out.rms_mm.push_back(drawn.rms_mm);
    out.max_mm.push_back(drawn.max_mm);
  }
  out.noise = field.per_noise();
  return out;
}

UncertaintyStatus residual_interval(double as_measured_mm, bool rms, const ResidualTrials& trials,
                                    std::vector<InfluenceStatement> declaration,
                                    const UncertaintyOptions& options) {
  TrialValues values;
  values.as_measured_mm = as_measured_mm;
  values.values_mm = rms ? trials.rms_mm : trials.max_mm;
  auto stated = statement_of_trials(
      std::move(values), {{"ball-centre", rms ? trials.noise.rms_mm : trials.noise.max_mm}},
      std::move(declaration), options);
  return stated ? UncertaintyStatus::stated(*std::move(stated), options.coverage)
                : UncertaintyStatus::none(stated.error().said());
}

}  // namespace rondure::evaluation
