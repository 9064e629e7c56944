#include "evaluation/wheel/internal/measured_axis.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

/// The least-squares circle of an envelope as its points determine it.
struct CenterOfPoints {
  /// (J^T J)^-1 of centre and radius, of points of unit variance along the radius.
  Eigen::Matrix3d per_variance = Eigen::Matrix3d::Zero();
  Eigen::Vector2d per_squareness_mm = Eigen::Vector2d::Zero();  ///< Shift for one radian.
};

core::Result<CenterOfPoints> center_of_points(const fit::WheelMeasurement& wheel,
                                              const std::string& id) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sheared = Eigen::Vector3d::Zero();
  const std::vector<double>& angles_rad = wheel.order.angles_rad;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    const double angle = angles_rad[i];
    if (i > 0 && angle == angles_rad[i - 1]) continue;  // a row given twice says nothing new
    const Eigen::Vector3d row(std::cos(angle), std::sin(angle), 1.0);
    normal += row * row.transpose();
    sheared += row * (wheel.radius_mm * row.x() * row.y());  // R / 2 sin 2 theta
  }
  CenterOfPoints out;
  bool invertible = false;
  normal.computeInverseWithCheck(out.per_variance, invertible, 1e-14);
  if (!invertible) {
    return core::fail(core::Code::kNoAxis,
                      core::phrase("the points of feature {} do not fix their centre", id));
  }
  out.per_squareness_mm = (out.per_variance * sheared).head<2>();
  return out;
}

/// Its columns, the greater first, give the covariance as a sum of squares.
Eigen::Matrix2d root_of(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Vector2d lengths = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  Eigen::Matrix2d out;
  out.col(0) = solver.eigenvectors().col(1) * lengths(1);
  out.col(1) = solver.eigenvectors().col(0) * lengths(0);
  return out;
}

}  // namespace

core::Result<MeasuredAxis> measured_axis(const WheelResult& swept, const std::string& id) {
  const fit::WheelMeasurement& wheel = swept.evaluation.wheel;
  if (wheel.mode != fit::WheelMode::kEnvelope || wheel.mean != fit::WheelMean::kLeastSquares) {
    return core::fail(
        core::Code::kNoAxis,
        core::phrase("feature {} is no wheel of mode envelope with the centre of least "
                     "squares, so it gives no axis",
                     id));
  }
  if (wheel.form_in_radius_mm() > 0.0) {
    // The covariance counts noise. Neighbouring residuals that are alike move the centre by more.
    return core::fail(
        core::Code::kNoAxis,
        core::phrase(
            "the points of feature {} see an arc, and neighbouring residuals are alike (tau "
            "{:.2f}): form moves its centre by an unknown amount; measure more of the "
            "circle",
            id, wheel.correlation));
  }
  TRY(const auto center, center_of_points(wheel, id));
  MeasuredAxis out;
  out.feature = id;
  out.center_mm = wheel.center_mm;
  if (!swept.declared) return out;
  if (swept.declared->point_um) {
    const double point_mm = record::u_of(swept.declared->point_um) * core::kMicrometre;
    out.root_mm = point_mm * root_of(center.per_variance.topLeftCorner<2, 2>());
  }
  out.squareness_urad = swept.declared->squareness_urad;
  out.per_squareness_mm = center.per_squareness_mm;
  return out;
}

}  // namespace rondure::evaluation
