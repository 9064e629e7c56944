#pragma once

#include <string_view>

namespace rondure::cmm::ipp {

/// Whether a method belongs to the language (any issue up to 1.5, with known additions); a server
/// need not support it. Case-sensitive.
[[nodiscard]] bool is_method(std::string_view name);

/// Whether a method travels on the fast queue: known, and its name ends in E.
[[nodiscard]] bool is_event_method(std::string_view name);

}  // namespace rondure::cmm::ipp
