#include "fit/geometry/registration.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/SVD>

#include "core/shortest_turn.h"

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

core::Result<void> check_pairs(SpacePoints from_mm, SpacePoints to_mm, std::size_t least) {
  if (from_mm.size() < least || from_mm.size() != to_mm.size()) {
    return core::fail_with(
        core::Code::kTooFewPoints,
        "{} and {} points do not determine a motion; at least {} pairs are needed", from_mm.size(),
        to_mm.size(), least);
  }
  if (!check_points(from_mm) || !check_points(to_mm)) {
    return core::fail(core::Code::kNotFinite,
                      "a point to be registered is not a finite number up to 1e7 mm");
  }
  return {};
}

}  // namespace

core::Result<Registration> rigid_registration(SpacePoints from_mm, SpacePoints to_mm,
                                              std::span<const double> weights) {
  TRY_DO(check_pairs(from_mm, to_mm, 3));
  const Eigen::Matrix3Xd from = columns(from_mm);
  const Eigen::Matrix3Xd to = columns(to_mm);
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

core::Result<Registration> plane_registration(SpacePoints from_mm, SpacePoints to_mm,
                                              const Plane& plane) {
  TRY_DO(check_pairs(from_mm, to_mm, 2));
  const Eigen::Matrix3Xd from = columns(from_mm);
  // The plane laid level, its point in the origin.
  const Eigen::Matrix3d lay = core::shortest_turn(plane.normal, Eigen::Vector3d::UnitZ());
  Eigen::Matrix3Xd level = lay * (columns(to_mm).colwise() - plane.point_mm);
  level.row(2).setZero();
  const Eigen::Vector3d from_mean = from.rowwise().mean();
  const Eigen::Vector3d level_mean = level.rowwise().mean();
  const Eigen::Matrix3Xd a = from.colwise() - from_mean;
  const Eigen::Matrix3Xd b = level.colwise() - level_mean;
  if (!(a.topRows<2>().squaredNorm() > 0.0)) {
    return core::fail(core::Code::kCollinear,
                      "the points coincide, so the turn about the normal is not determined");
  }
  const double along = (a.topRows<2>().cwiseProduct(b.topRows<2>())).sum();
  const double across = a.row(0).dot(b.row(1)) - a.row(1).dot(b.row(0));
  const Eigen::AngleAxisd turn(std::atan2(across, along), Eigen::Vector3d::UnitZ());
  Registration out;
  out.motion.linear() = lay.transpose() * turn.toRotationMatrix();
  out.motion.translation() =
      plane.point_mm + lay.transpose() * level_mean - out.motion.linear() * from_mean;
  // All points of one height lie on the plane: what is left is within it.
  out.largest_residual_mm =
      std::sqrt((turn.toRotationMatrix() * a - b).topRows<2>().colwise().squaredNorm().maxCoeff());
  return out;
}

}  // namespace rondure::fit
