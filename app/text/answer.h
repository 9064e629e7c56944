#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/result.h"

namespace rondure::app {

/// @return kNotFinite naming the first number of a document that is not finite (JSON would write
///         it as null, a table as nan), or nothing.
[[nodiscard]] core::Result<void> check_finite(const nlohmann::ordered_json& found);

/// Warnings as the JSON of every verb has them, {"code", "what"} each.
[[nodiscard]] nlohmann::ordered_json warnings_json(const std::vector<core::Error>& warnings);
/// Warnings as the last lines of a table.
[[nodiscard]] std::string warnings_text(const std::vector<core::Error>& warnings);

/// Prints a result, as JSON or as a table. If a number is not finite, only the error is printed.
/// @return The exit status of the verb.
[[nodiscard]] int answer(const nlohmann::ordered_json& found, bool as_json,
                         const std::function<std::string()>& table);

}  // namespace rondure::app
