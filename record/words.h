#pragma once

#include <optional>
#include <string_view>
#include <type_traits>

#include "core/words.h"

namespace rondure::record {

// The order of words is that in which the schema and the messages of plans list them.

/// An enum with the function words_of(Enum).
template <class Enum>
concept Worded = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value);
};

/// The spelling of a value.
template <Worded Enum>
[[nodiscard]] constexpr std::string_view name_of(Enum value) {
  return core::word_for(words_of(value), value);
}

/// The value with that spelling; nothing for an unknown word.
template <Worded Enum>
[[nodiscard]] constexpr std::optional<Enum> value_named(std::string_view text) {
  for (const auto& word : words_of(Enum{})) {
    if (word.text == text) return word.value;
  }
  return std::nullopt;
}

}  // namespace rondure::record
