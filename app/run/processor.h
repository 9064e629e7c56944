#pragma once

#include <string>

namespace rondure::app {

/// Model and vector units of this processor; results are bit-identical on the same kind only.
[[nodiscard]] std::string processor();

/// The current time as ISO 8601 in UTC: "2026-11-21T02:33:02Z".
[[nodiscard]] std::string utc_now();

}  // namespace rondure::app
