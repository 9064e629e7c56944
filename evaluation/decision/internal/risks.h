#pragma once

#include <optional>

#include "evaluation/decision/decision.h"

// Private to the room: probabilities behind the rules of decision.h.

namespace rondure::evaluation {

/// The probability that a part conforms, whose distribution is the one behind `known` moved by
/// `shift_mm`, and weighted by the prior where there is one: JCGM 106, 7.2. Nothing when there is
/// no distribution, or the prior gives fewer than 50 of its values weight.
[[nodiscard]] std::optional<double> conformance(const UncertaintyStatement& known,
                                                const std::optional<Prior>& prior, double shift_mm,
                                                double tolerance_mm);

}  // namespace rondure::evaluation
