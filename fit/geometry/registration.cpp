#include "fit/geometry/registration.h"

#include <algorithm>
#include <cassert>

#include <Eigen/SVD>

namespace rondure::fit {
namespace {

/// Points as columns of a matrix.
Eigen::Matrix3Xd columns(SpacePoints points_mm) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(points_mm.size()));
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    out.col(static_cast<Eigen::Index>(i)) = points_mm[i];
  }
  return out;
}

bool on_one_line(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d products = centred * centred.transpose();
  const Eigen::Vector3d squares = Eigen::JacobiSVD<Eigen::Matrix3d>(products).singularValues();
  return squares(1) <= 1e-12 * squares(0);
}

/// The motion for weights whose sum is 1.
Eigen::Isometry3d best_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                              const Eigen::VectorXd& weights) {
  const Eigen::Vector3d from_mean = from * weights;
  const Eigen::Vector3d to_mean = to * weights;
  const Eigen::Matrix3d products =
      (to.colwise() - to_mean) * weights.asDiagonal() * (from.colwise() - from_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  out.translation() = to_mean - out.linear() * from_mean;
  return out;
}

}  // namespace

core::Result<Registration> rigid_registration(SpacePoints from_mm, SpacePoints to_mm,
                                              std::span<const double> weights) {
  if (from_mm.size() < 3 || from_mm.size() != to_mm.size()) {
    return core::fail_with(
        core::Code::kTooFewPoints,
        "{} and {} points do not determine a motion; at least 3 pairs are needed", from_mm.size(),
        to_mm.size());
  }
  const Eigen::Matrix3Xd from = columns(from_mm);
  const Eigen::Matrix3Xd to = columns(to_mm);
  if (!check_points(from_mm) || !check_points(to_mm)) {
    return core::fail(core::Code::kNotFinite,
                      "a point to be registered is not a finite number up to 1e7 mm");
  }
  if (on_one_line(from)) {
    return core::fail(core::Code::kCollinear,
                      "the points lie on one line, so the turn about it is not determined");
  }
  assert(weights.empty() || weights.size() == from_mm.size());
  Eigen::VectorXd share = Eigen::VectorXd::Ones(from.cols());
  if (!weights.empty()) share = Eigen::Map<const Eigen::VectorXd>(weights.data(), from.cols());
  Registration out;
  out.motion = best_motion(from, to, share / share.sum());
  for (std::size_t i = 0; i < from_mm.size(); ++i) {
    out.largest_residual_mm =
        std::max(out.largest_residual_mm, (out.motion * from_mm[i] - to_mm[i]).norm());
  }
  return out;
}

}  // namespace rondure::fit
