#pragma once

#include <string>
#include <vector>

namespace rondure::fuzz {

// Valid files of every kind from tests/data, thinned so that a case takes little time.

[[nodiscard]] const std::vector<std::string>& point_tables();
[[nodiscard]] const std::vector<std::string>& ball_tables();
[[nodiscard]] const std::vector<std::string>& spindle_tables();
[[nodiscard]] const std::vector<std::string>& roundness_tables();
/// Points of wheels first, then a surface and a removal.
[[nodiscard]] const std::vector<std::string>& wheel_tables();
/// Axes, then pin, then further tables.
[[nodiscard]] const std::vector<std::string>& contour_tables();

// Words to put into damaged files.

[[nodiscard]] const std::vector<std::string>& table_words();
[[nodiscard]] const std::vector<std::string>& json_words();

}  // namespace rondure::fuzz
