#pragma once

#include <string>

#include "evaluation/decision/decision.h"

namespace rondure::reports {

/// The rule in words of the language of the report, with its formula: "ISO 14253-1: conforms where
/// y + f (hi - y) <= T, ...; f = 1; ...".
[[nodiscard]] std::string in_words(const evaluation::DecisionRule& rule);

}  // namespace rondure::reports
