#pragma once

#include <array>
#include <string_view>

namespace rondure::core {

/// The spelling of an enumerator.
template <class Enum>
struct Word {
  Enum value;
  std::string_view text;
};

template <class Words, class Enum>
[[nodiscard]] constexpr std::string_view word_for(const Words& words, Enum value) {
  for (const auto& word : words) {
    if (word.value == value) return word.text;
  }
  return {};
}

}  // namespace rondure::core

/// Declares words_of(Enum), which returns an array with one Word for each enumerator, and
/// name_of(Enum value), the word of one; empty for none. They stand beside the enum:
/// RONDURE_WORDS(Side, {kOutside, "outside"}, {kInside, "inside"});
#define RONDURE_WORDS(Enum, ...)                                      \
  constexpr auto words_of(Enum) {                                     \
    using enum Enum;                                                  \
    return std::to_array<::rondure::core::Word<Enum>>({__VA_ARGS__}); \
  }                                                                   \
  [[nodiscard]] constexpr std::string_view name_of(Enum value) {      \
    return ::rondure::core::word_for(words_of(value), value);         \
  }                                                                   \
  static_assert(true)
