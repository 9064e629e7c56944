#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/phrase.h"
#include "core/result.h"
#include "evaluation/results/evaluation.h"

// A feature that takes a value of an earlier one is void where that one is: it would be judged by a
// number that proves nothing.

namespace rondure::evaluation {

/// The feature that gives a value to a later one.
/// @param earlier  Features that were evaluated and judged, in the order of the plan.
/// @return  Its result; or why nothing can be taken from it: there is none with that id, or it is
///          void, with its reason.
[[nodiscard]] core::Result<const FeatureResult*> producer_of(
    const std::string& id, std::span<const FeatureResult> earlier);

/// The gate "chain-void" of a feature that takes a value.
/// @param void_because  Why the value cannot be taken; none: it can.
[[nodiscard]] Gate chain_gate(const std::string& producer,
                              const std::optional<core::Phrase>& void_because);

/// Why all characteristics of a feature are void: its gate "chain-void".
[[nodiscard]] std::optional<core::Phrase> chain_fault(const FeatureResult& result);

}  // namespace rondure::evaluation
