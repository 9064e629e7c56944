#include "app/verbs/word_option.h"

#include <utility>

#include <CLI/CLI.hpp>

namespace rondure::app {

CLI::Option* add_word(CLI::App& verb, const std::string& name,
                      const std::vector<std::string>& words,
                      std::function<void(const std::string&)> take, const std::string& meaning) {
  return verb.add_option_function<std::string>(name, std::move(take), meaning)
      ->check(CLI::IsMember(words));
}

}  // namespace rondure::app
