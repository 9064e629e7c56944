#pragma once

#include <cstddef>
#include <optional>

#include "plans/path/scene.h"

namespace rondure::plans {

/// A way from park height down to a pre-touch point that leads around what bars the straight ones,
/// machine frame: straight up, or from place to place of a grid about the point until the tip can
/// rise, cut short where a straight move is clear. Every move is checked against the scene, with
/// the gaps of Phase::kNear. Same scene and point, same way.
///
/// @param moves_left  Moves that may still be checked; less those that were.
/// @return  Nothing when the tool cannot stand there, or no way was found within kDetourReach_mm or
///          with the moves left.
[[nodiscard]] std::optional<Way> detour(const Scene& scene, const Placement& placement,
                                        const PathGeometry& geometry,
                                        const Eigen::Vector3d& pre_touch_W_mm, double sky_mm,
                                        std::size_t& moves_left);

inline constexpr double kDetourStep_mm = 10.0;    ///< Of the grid, sideways.
inline constexpr double kDetourReach_mm = 100.0;  ///< From the point, along each axis.

}  // namespace rondure::plans
