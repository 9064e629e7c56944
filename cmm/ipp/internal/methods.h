#pragma once

#include <string_view>

namespace rondure::cmm::ipp {

/// Whether a method is in the language at all (any issue up to 1.5 with the additions we know); a
/// server need not support it. Case counts.
[[nodiscard]] bool is_method(std::string_view name);

/// Whether it travels on the fast queue: known, and its name ends in E.
[[nodiscard]] bool is_event_method(std::string_view name);

}  // namespace rondure::cmm::ipp
