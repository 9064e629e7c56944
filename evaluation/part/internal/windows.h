#pragma once

#include <span>
#include <vector>

#include "core/result.h"
#include "record/tasks/surface.h"

// Private to the room: which points lie in the windows of a surface.

namespace rondure::evaluation {

/// Place of a point in the part: angle about the axis of the feature, height of its tip centre; of
/// a plane the distance from its middle in place of the height.
struct PartPlace {
  double angle_rad = 0.0;
  double z_mm = 0.0;
  double radius_mm = 0.0;
};

/// @return kMeaning for a window that is empty or the whole turn, whatever its angles say.
[[nodiscard]] core::Result<void> check_window(const record::WindowTask& window);

/// Whether a point lies in a window widened on all sides by its guard.
/// @pre check_window() holds.
[[nodiscard]] bool is_in(const record::WindowTask& window, const PartPlace& place,
                         double default_guard_mm);

/// Marks the points of a section that lie farther than a limit from its robust profile: harmonics
/// up to 15, as far as the points carry them, by Tukey's weights, from the circle of the points
/// outside the window.
/// @param angle_rad, r_mm  Polar about any centre near that of the section.
/// @param in_window  As many as points.
/// @return kTooFewPoints where the points outside the window determine no circle.
[[nodiscard]] core::Result<std::vector<bool>> off_profile(std::span<const double> angle_rad,
                                                          std::span<const double> r_mm,
                                                          const std::vector<bool>& in_window,
                                                          double limit_mm);

}  // namespace rondure::evaluation
