#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "plans/path/sampling.h"

namespace rondure::plans {

/// Parameters of the path of the tip around a part. Part frame, heights as in the plan.
struct PathGeometry {
  double radius_mm = 0.0;  ///< Nominal radius; the greatest one of a surface that is no cylinder.
  double from_mm = 0.0;    ///< Lower end of the part.
  double to_mm = 0.0;      ///< Upper end of the part.
  bool inside = false;     ///< true: a bore, open above.
  double tip_radius_mm = 2.0;
  double approach_mm = 3.0;   ///< Distance from the pre-touch point to the expected contact.
  double clearance_mm = 5.0;  ///< Distance from all obstacles while travelling.
  double location_mm = 0.0;   ///< How far the part may be off; approach and clearance contain it.
  double stand_off_mm = 0.0;  ///< Added to the radius of the path around a shaft.
  /// The surface in this room; none: the cylinder of `radius_mm`.
  std::optional<SurfaceChart> surface = {};

  friend bool operator==(const PathGeometry&, const PathGeometry&) = default;
};

/// Corners of a path of the tip centre, joined by straight moves, part frame [mm].
using Polyline = std::vector<Eigen::Vector3d>;

/// kMeaning when tip and approach do not fit into the bore.
[[nodiscard]] core::Result<void> check_fits(const PathGeometry& geometry);

/// Unit vector from the pre-touch point toward the surface.
[[nodiscard]] Eigen::Vector3d approach_direction(const PathGeometry& geometry,
                                                 const Target& target);

/// Tip centre at the nominal contact.
[[nodiscard]] Eigen::Vector3d contact_tip(const PathGeometry& geometry, const Target& target);

/// Tip centre where the search begins.
[[nodiscard]] Eigen::Vector3d pre_touch(const PathGeometry& geometry, const Target& target);

/// Path from above the upper end of the part to a pre-touch point. The first corner is tip radius +
/// clearance beyond the end plane: a motion between it and the sky, straight along machine z, does
/// not meet a part that is tilted by 90 deg or less.
[[nodiscard]] Polyline entry_path(const PathGeometry& geometry, const Target& target);

/// Path between two pre-touch points, both included. Outside: out to the travel radius, along the
/// axis, around (the shorter direction) and in again; on the path around, no point is closer to the
/// axis than radius + tip radius + max(approach, clearance). Inside: the straight line. On a plane:
/// off it by max(approach, clearance), around the axis and along the radius.
[[nodiscard]] Polyline path_between(const PathGeometry& geometry, const Target& from,
                                    const Target& to);

/// The reverse of entry_path().
[[nodiscard]] Polyline exit_path(const PathGeometry& geometry, const Target& target);

/// Path around a reference sphere between two directions of qualification_directions(): from
/// pre-touch point to pre-touch point, both included, never closer to the sphere than these.
/// Machine frame.
[[nodiscard]] Polyline path_around_sphere(const Eigen::Vector3d& center_W_mm, double radius_mm,
                                          const PathGeometry& geometry, const Eigen::Vector3d& from,
                                          const Eigen::Vector3d& to);

}  // namespace rondure::plans
