#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::core {

/// The shortest text that reads back to the same double ("0.1", "1e-09"); never a locale's comma.
/// `value` must be finite.
[[nodiscard]] std::string shortest(double value);

/// Reads the whole of `text` as one finite number, or nothing. Spaces around it are not accepted.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

}  // namespace rondure::core
