#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "record/words.h"

namespace rondure::app {

/// Adds an option whose words spell an enum.
/// @param value  Set to the enumerator of the word; also an optional one.
/// @param but    Enumerators that the option does not take.
template <record::Worded Enum, class Value>
CLI::Option* add_words(CLI::App& verb, const std::string& name, Value& value,
                       const std::string& meaning, const std::vector<Enum>& but = {}) {
  std::vector<std::string> words;
  for (const auto& word : words_of(Enum{})) {
    if (std::find(but.begin(), but.end(), word.value) == but.end()) words.emplace_back(word.text);
  }
  return verb
      .add_option_function<std::string>(
          name,
          [&value](const std::string& word) {
            if (const auto named = record::value_named<Enum>(word)) value = *named;
          },
          meaning)
      ->check(CLI::IsMember(words));
}

}  // namespace rondure::app
