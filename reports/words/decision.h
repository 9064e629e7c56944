#pragma once

#include <string>

#include "evaluation/decision/decision.h"

namespace rondure::reports {

/// The rule in words, with its formula: "ISO 14253-1: conforms where y + 1 (hi - y) <= T, ...".
[[nodiscard]] std::string in_words(const evaluation::DecisionRule& rule);

}  // namespace rondure::reports
