#pragma once

#include <vector>

namespace rondure::core {

/// The largest 1, 2 or 5 times a power of ten that is not above `limit`, which must be > 0: the
/// length of a scale bar.
[[nodiscard]] double round_below(double limit);

/// Round values within [low, high], about `wanted` of them (1, 2 or 5 times a power of ten apart),
/// for the ticks of an axis. Only `low` if `high` is not above it.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int wanted);

/// 1, 2, 5, 10, ... within [low, high], both > 0; only powers of ten when there are more than three
/// decades.
[[nodiscard]] std::vector<double> decade_ticks(double low, double high);

/// The angle in degrees, as the number with the fewest digits that is this angle to the last bit:
/// 60 deg of a plan leave as 60, not as 59.99999999999999.
[[nodiscard]] double stated_degrees(double angle_rad);

}  // namespace rondure::core
