#pragma once

#include <string>

namespace CLI {
class App;
}

namespace rondure::app {

/// The manual page of the program in roff (man macros), generated from the table that parses the
/// command line and prints --help. View it with `man -l`.
[[nodiscard]] std::string manual_page(const CLI::App& program);

/// A bash script that completes verbs, options, listed words and file names, from the same table.
[[nodiscard]] std::string bash_completion(const CLI::App& program);

}  // namespace rondure::app
