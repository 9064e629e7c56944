#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rondure::core {

/// Seconds since 1970-01-01T00:00:00Z of a time such as "2026-11-21T02:33:02Z": years 1970 to 9999,
/// a day that exists, no leap second, no other form. Nothing for any other text.
[[nodiscard]] std::optional<std::int64_t> parse_utc(std::string_view text);

/// The same back; the reverse of parse_utc() in those years.
[[nodiscard]] std::string utc_text(std::int64_t seconds);

}  // namespace rondure::core
