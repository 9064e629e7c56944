#include "cmm/ipp/frames.h"

#include "core/units.h"

namespace rondure::cmm::ipp {

Eigen::Isometry3d machine_to_csy(const CsyTransformation& transformation) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  // The axes turn, so the coordinates of a fixed point turn in the opposite sense.
  const Eigen::Matrix3d axes =
      (AngleAxisd(transformation.psi_deg * core::kDegree, Vector3d::UnitZ()) *
       AngleAxisd(transformation.theta_deg * core::kDegree, Vector3d::UnitX()) *
       AngleAxisd(transformation.phi_deg * core::kDegree, Vector3d::UnitZ()))
          .toRotationMatrix();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = axes.transpose();
  out.translation() = -(out.linear() * transformation.x0_mm);
  return out;
}

}  // namespace rondure::cmm::ipp
