#pragma once

#include <string>
#include <vector>

namespace rondure::fuzz {

// Good files of every kind out of tests/data, thinned so that a case takes little time.

[[nodiscard]] const std::vector<std::string>& point_tables();
[[nodiscard]] const std::vector<std::string>& ball_tables();
[[nodiscard]] const std::vector<std::string>& spindle_tables();
[[nodiscard]] const std::vector<std::string>& roundness_tables();
/// Points of wheels first, then a surface and a removal.
[[nodiscard]] const std::vector<std::string>& wheel_tables();
/// Axes, then pin; further ones.
[[nodiscard]] const std::vector<std::string>& contour_tables();

}  // namespace rondure::fuzz
