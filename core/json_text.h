#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.h"

// The one place where JSON of files is read. Plans have a reader of their own, which keeps the
// order of values and repeated keys (plans/schema/json_text.h), with the same depth.

namespace rondure::core {

/// Deepest nesting of arrays and objects. Programs that walk a document call themselves at each
/// level: one of a million brackets would exhaust the stack.
inline constexpr std::size_t kDeepestJson = 64;
/// Most bytes of a document.
inline constexpr std::size_t kMostJsonBytes = std::size_t{64} << 20;

/// Checks length and depth before anything is parsed. The text need not be JSON.
/// @param name  Name of the file, for `where`.
/// @return kSyntax with number and limit.
[[nodiscard]] Result<void> check_json(std::string_view text, std::string_view name);

/// The error for a text that stops being JSON at `byte`, counted from 1.
[[nodiscard]] Error json_fault(std::string_view text, std::size_t byte, std::string_view name);

/// Reads a JSON document.
/// @tparam Json  nlohmann::json or nlohmann::ordered_json, which the caller includes.
/// @return kSyntax with the place: no JSON, longer or deeper than the limits, a number beyond the
///         range of double.
template <class Json>
[[nodiscard]] Result<Json> read_json(std::string_view text, std::string_view name) {
  if (auto sound = check_json(text, name); !sound) return fail(sound.error());
  try {
    return Result<Json>(tl::in_place, Json::parse(text));
  } catch (const typename Json::parse_error& error) {
    return fail(json_fault(text, error.byte, name));
  } catch (const typename Json::exception&) {
    return fail(Code::kSyntax, "a number in the text is beyond the limit of 1.8e308",
                std::string(name));
  }
}

}  // namespace rondure::core
