#pragma once

#include <string>

namespace rondure::app {

/// A word of a command line, quoted for a shell if necessary.
[[nodiscard]] std::string quoted(const std::string& word);

}  // namespace rondure::app
