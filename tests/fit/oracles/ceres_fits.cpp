#include "ceres_fits.h"

#include <vector>

#include <ceres/ceres.h>

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace rondure::test {
namespace {

struct CircleDistance {
  Eigen::Vector2d p;
  template <class T>
  bool operator()(const T* x, T* residual) const {
    const T u = T(p.x()) - x[0];
    const T v = T(p.y()) - x[1];
    residual[0] = sqrt(u * u + v * v) - x[2];
    return true;
  }
};

/// Offset of a point from the axis through (x0, x1, 0) along (x2, x3, 1), frame of the start.
template <class T>
Eigen::Matrix<T, 3, 1> offset(const Eigen::Vector3d& p, const T* x) {
  const Eigen::Matrix<T, 3, 1> along(x[2], x[3], T(1.0));
  const Eigen::Matrix<T, 3, 1> v(T(p.x()) - x[0], T(p.y()) - x[1], T(p.z()));
  return v - along * (v.dot(along) / along.squaredNorm());
}

struct CylinderDistance {
  Eigen::Vector3d p;
  template <class T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = offset(p, x).norm() - x[4];
    return true;
  }
};

/// Gauss-Newton steps with Ceres' derivatives and without its test for a lower cost, which cannot
/// see the last digits: near the minimum the cost changes with the square of the error.
template <int Unknowns>
void polish(ceres::Problem& problem, Eigen::Matrix<double, Unknowns, 1>& x) {
  for (int step = 0; step < 6; ++step) {
    std::vector<double> residuals;
    ceres::CRSMatrix sparse;
    problem.Evaluate({}, nullptr, &residuals, nullptr, &sparse);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row) {
      const auto begin = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row)]);
      const auto end = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row) + 1]);
      for (std::size_t k = begin; k < end; ++k) jacobian(row, sparse.cols[k]) = sparse.values[k];
    }
    const Eigen::Map<Eigen::VectorXd> r(residuals.data(), sparse.num_rows);
    x -= jacobian.colPivHouseholderQr().solve(r);
  }
}

/// Solves as far as doubles go.
template <class Cost, int Unknowns, class Points>
void solve(const Points& points, Eigen::Matrix<double, Unknowns, 1>& x) {
  ceres::Problem problem;
  for (const auto& p : points) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Cost, 1, Unknowns>(new Cost{p}),
                             nullptr, x.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 500;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 1e-17;
  options.parameter_tolerance = 1e-16;
  options.initial_trust_region_radius = 1e8;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  polish(problem, x);
}

}  // namespace

CeresCircle ceres_circle(std::span<const Eigen::Vector2d> points_mm, const CeresCircle& start) {
  std::vector<Eigen::Vector2d> local;
  for (const auto& p : points_mm) local.emplace_back(p - start.center_mm);
  Eigen::Vector3d x(0.0, 0.0, start.radius_mm);
  solve<CircleDistance, 3>(local, x);
  return {start.center_mm + x.head<2>(), x(2)};
}

CeresCylinder ceres_cylinder(std::span<const Eigen::Vector3d> points_mm,
                             const CeresCylinder& start) {
  // The start's axis is z, its point the origin.
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), start.direction);
  std::vector<Eigen::Vector3d> local;
  for (const auto& p : points_mm) local.emplace_back(turn.conjugate() * (p - start.point_mm));
  Eigen::Vector<double, 5> x(0.0, 0.0, 0.0, 0.0, start.radius_mm);
  solve<CylinderDistance, 5>(local, x);
  return {start.point_mm + turn * Eigen::Vector3d(x(0), x(1), 0.0),
          (turn * Eigen::Vector3d(x(2), x(3), 1.0)).normalized(), x(4)};
}

}  // namespace rondure::test
