#pragma once

#include <algorithm>
#include <optional>

#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// Why nothing of the feature may reach a machine.
[[nodiscard]] inline std::optional<core::Phrase> barred(const FeatureResult& result) {
  if (result.failure) return result.failure->said();
  const auto voids = std::ranges::find_if(
      result.gates, [](const Gate& gate) { return gate.outcome == Gate::Outcome::kVoids; });
  if (voids != result.gates.end()) return voids->reason;
  if (!result.analysis) return core::phrase("the feature has no result");
  return std::nullopt;
}

}  // namespace rondure::evaluation
