#pragma once

#include <optional>

#include "evaluation/decision/decision.h"

// Private to the room: the probabilities that the rules of decision.h compare.

namespace rondure::evaluation {

/// The probability that a part conforms whose distribution is that of `known` shifted by `shift_mm`
/// and, where there is a prior, weighted by it: JCGM 106, 7.2. None when there is no distribution,
/// or when the prior gives weight to fewer than 50 of its values.
[[nodiscard]] std::optional<double> conformance(const UncertaintyStatement& known,
                                                const std::optional<Prior>& prior, double shift_mm,
                                                const Limits& limits);

}  // namespace rondure::evaluation
