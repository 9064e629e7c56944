#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/profiles/closed_profile.h"

// Private to the room: sections as profiles, and what cut-off they carry.

namespace rondure::evaluation {

/// Points per undulation at a cut-off.
inline constexpr double kProfilePointsPerUndulation = 7.0;

/// A section about its least-squares circle.
struct RoundProfile {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> outward;  ///< Unit directions from the centre.
  std::vector<double> theta_rad;
  std::vector<double> r_mm;      ///< From the circle.
  fit::AngularProfile by_angle;  ///< The same, sorted.
};

/// @return The errors of fit::ls_circle() and fit::ordered_profile().
[[nodiscard]] core::Result<RoundProfile> round_profile(std::span<const Eigen::Vector2d> points_mm);

/// Points of a whole turn and the widest gap that no window made.
struct Spacing {
  double points = 0.0;
  double gap_rad = 0.0;
};

/// @param left_out  Places that windows took out of the section: only what these stand for is no
///                  gap.
[[nodiscard]] Spacing spacing_of(const RoundProfile& profile,
                                 std::span<const Eigen::Vector2d> left_out);

/// Whether there are 7 points per undulation and no gap of a quarter of one.
[[nodiscard]] bool carries(const Spacing& spacing, double cutoff_upr);

/// Whether a section carries the lowest usual cut-off, 15 UPR: it may then be read as a profile.
/// @param left_out_mm  As of spacing_of().
[[nodiscard]] bool carries_lowest_cutoff(std::span<const Eigen::Vector3d> points_mm,
                                         const fit::Axis& axis,
                                         std::span<const Eigen::Vector3d> left_out_mm);

}  // namespace rondure::evaluation
