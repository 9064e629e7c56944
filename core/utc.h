#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rondure::core {

/// Converts a time such as "2026-11-21T02:33:02Z" to seconds since 1970-01-01T00:00:00Z. Accepts
/// this form only, with years 1970 to 9999, a day that exists and no leap second.
/// @return The seconds, or nothing for any other text.
[[nodiscard]] std::optional<std::int64_t> parse_utc(std::string_view text);

/// Converts seconds to text; the inverse of parse_utc() for the years 1970 to 9999.
[[nodiscard]] std::string utc_text(std::int64_t seconds);

}  // namespace rondure::core
