#pragma once

#include <Eigen/Core>

#include "cmm/simulated/part.h"
#include "core/result.h"

namespace rondure::cmm {

/// First contact of the sphere of a probe tip with a part, in the part frame.
struct Contact {
  double travel_mm = 0.0;                                ///< Travel from the start, >= 0.
  Eigen::Vector3d tip_P_mm = Eigen::Vector3d::Zero();    ///< Tip centre at contact.
  Eigen::Vector3d point_P_mm = Eigen::Vector3d::Zero();  ///< Contact point on the part.
};

/// Moves a sphere along a straight line until it first meets the real part: its side (with all of
/// its form), a rim or a flat end; for a bore also the outer wall of the block. Exact: the contact
/// is the least travel at which the sphere reaches any point of the part, so a tip bridges a valley
/// that is narrower than itself.
///
/// @param start_P_mm  Tip centre at the start.
/// @param direction_P  Unit vector of the motion.
/// @param tip_radius_mm  > 0.
/// @param max_travel_mm  Largest travel of the tip, >= 0.
/// @return  The contact; kCollision when the sphere overlaps the part at its start by more than
///          1e-9 mm, kNoTouch when it meets nothing, kNotConverged if the solver fails.
[[nodiscard]] core::Result<Contact> first_contact(const PartSurface& surface,
                                                  const Eigen::Vector3d& start_P_mm,
                                                  const Eigen::Vector3d& direction_P,
                                                  double tip_radius_mm, double max_travel_mm);

/// The same with a face or a ball, in the frame of the surface; a face is met from its free side
/// only, and on its ring only. Also kNotConverged where the tip does not reach into the form.
[[nodiscard]] core::Result<Contact> first_contact(const FaceSurface& surface,
                                                  const Eigen::Vector3d& start_P_mm,
                                                  const Eigen::Vector3d& direction_P,
                                                  double tip_radius_mm, double max_travel_mm);
[[nodiscard]] core::Result<Contact> first_contact(const BallSurface& surface,
                                                  const Eigen::Vector3d& start_P_mm,
                                                  const Eigen::Vector3d& direction_P,
                                                  double tip_radius_mm, double max_travel_mm);

/// First contact with a single sphere, e.g. the reference sphere of a probe qualification. Same
/// errors. Any frame.
[[nodiscard]] core::Result<Contact> first_contact_with_sphere(
    const Eigen::Vector3d& center_mm, double radius_mm, const Eigen::Vector3d& start_mm,
    const Eigen::Vector3d& direction, double tip_radius_mm, double max_travel_mm);

}  // namespace rondure::cmm
