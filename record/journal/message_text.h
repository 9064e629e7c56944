#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/message.h"

// Messages as stored in the journal (docs/developer/journal.md, table decision).

namespace rondure::record {

/// The arguments as JSON on one line, in the order of core::arguments_of(), each number as the
/// shortest text that reads back to the same double: {"touches":60,"reason":"..."}. A number that
/// is not finite is null.
[[nodiscard]] std::string arguments_json(const core::Message& message);

/// Reads a code and its arguments; nothing for an unknown code, and for any text that
/// arguments_json() would not write. null becomes infinity.
[[nodiscard]] std::optional<core::Message> read_message(std::string_view code,
                                                        std::string_view arguments);

}  // namespace rondure::record
