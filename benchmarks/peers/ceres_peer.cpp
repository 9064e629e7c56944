#include "benchmarks/peers/ceres_peer.h"

#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <Eigen/Geometry>

namespace rondure::benchmarks {
namespace {

/// Distance of a point, seen from the start frame, from the line (a, b, 0) + s (c, d, 1), less R.
struct RadialResidual {
  Eigen::Vector3d p;

  template <class T>
  bool operator()(const T* unknowns, T* residual) const {
    using std::sqrt;
    const T x = p.x() - unknowns[0];
    const T y = p.y() - unknowns[1];
    const T& c = unknowns[2];
    const T& d = unknowns[3];
    const T along = (x * c + y * d + p.z()) / (c * c + d * d + 1.0);
    const T u = x - along * c;
    const T v = y - along * d;
    const T w = p.z() - along;
    residual[0] = sqrt(u * u + v * v + w * w) - unknowns[4];
    return true;
  }
};

}  // namespace

CeresCylinder ceres_ls_cylinder(std::span<const Eigen::Vector3d> points_mm,
                                const Eigen::Vector3d& start_direction) {
  Eigen::Matrix3d frame;
  frame << fit::across(start_direction), start_direction;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) mean += p;
  mean /= static_cast<double>(points_mm.size());

  std::array<double, 5> unknowns{};
  ceres::Problem problem;
  for (const Eigen::Vector3d& p : points_mm) {
    const Eigen::Vector3d q = frame.transpose() * (p - mean);
    unknowns[4] += q.head<2>().norm() / static_cast<double>(points_mm.size());
    auto* cost = new ceres::AutoDiffCostFunction<RadialResidual, 1, 5>(new RadialResidual{q});
    problem.AddResidualBlock(cost, nullptr, unknowns.data());  // takes ownership
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  CeresCylinder out;
  out.axis.point_mm = mean + frame * Eigen::Vector3d(unknowns[0], unknowns[1], 0.0);
  out.axis.direction = (frame * Eigen::Vector3d(unknowns[2], unknowns[3], 1.0)).normalized();
  out.radius_mm = unknowns[4];
  out.rms_mm = std::sqrt(2.0 * summary.final_cost / static_cast<double>(points_mm.size()));
  return out;
}

}  // namespace rondure::benchmarks
