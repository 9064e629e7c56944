#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "record/words.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace rondure::app {

/// Adds an option that takes one of these words and hands it to `take`.
CLI::Option* add_word(CLI::App& verb, const std::string& name,
                      const std::vector<std::string>& words,
                      std::function<void(const std::string&)> take, const std::string& meaning);

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
  const auto take = [&value](const std::string& word) {
    if (const auto named = record::value_named<Enum>(word)) value = *named;
  };
  return add_word(verb, name, words, take, meaning);
}

}  // namespace rondure::app
