#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <type_traits>

namespace rondure::record {

/// The spelling of an enumerator in plans and journals.
template <class Enum>
struct Word {
  Enum value;
  std::string_view text;
};

/// Declares the function words_of(Enum), which returns an array with one Word for each enumerator,
/// in the order in which the schema and the messages of plans list them:
/// RONDURE_WORDS(Side, {kOutside, "outside"}, {kInside, "inside"});
#define RONDURE_WORDS(Enum, ...)                                        \
  constexpr auto words_of(Enum) {                                       \
    using enum Enum;                                                    \
    return std::to_array<::rondure::record::Word<Enum>>({__VA_ARGS__}); \
  }                                                                     \
  static_assert(true)

/// An enum with the function words_of(Enum).
template <class Enum>
concept Worded = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value);
};

/// The spelling of a value.
template <Worded Enum>
[[nodiscard]] constexpr std::string_view name_of(Enum value) {
  for (const auto& word : words_of(value)) {
    if (word.value == value) return word.text;
  }
  return {};
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
