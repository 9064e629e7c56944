#pragma once

#include <Eigen/Geometry>

namespace rondure::cmm::ipp {

/// The six numbers of SetCsyTransformation().
struct CsyTransformation {
  Eigen::Vector3d x0_mm = Eigen::Vector3d::Zero();
  double theta_deg = 0.0;  ///< 0..180.
  double psi_deg = 0.0;
  double phi_deg = 0.0;
};

/// Maps the machine frame to the system: turn about z by psi, the new x by theta, the new z by phi,
/// x_csy = R (x_machine - x0). This follows the chapter on machines, and VDMA 8722; the description
/// of the command in 1.4.3 has x_csy = R x_machine + x0, and servers follow either.
[[nodiscard]] Eigen::Isometry3d machine_to_csy(const CsyTransformation& transformation);

/// The point meant by the coordinates in PtMeas and the start in ScanOnCircle. The specification
/// means the surface (6.3.2.13: the approach includes the tool radius); some servers take the
/// centre of the tip. The reported point is the centre of the tip in both cases.
enum class NamedPoint { kSurface, kCenter };

}  // namespace rondure::cmm::ipp
