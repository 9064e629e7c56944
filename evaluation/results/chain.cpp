#include "evaluation/results/chain.h"

#include <algorithm>

namespace rondure::evaluation {
namespace {

constexpr const char* kChainVoid = "chain-void";
/// This gate voids the path alone: centre and radius of the wheel stand.
constexpr const char* kPathGate = "path-radius";

/// Why a feature is void as a whole, or one of its characteristics is.
std::optional<core::Phrase> why_void(const FeatureResult& producer) {
  if (producer.failure) return producer.failure->said();
  if (!producer.analysis) return core::phrase("there is no result");
  for (const Gate& gate : producer.gates) {
    if (gate.outcome == Gate::Outcome::kVoids && gate.code != kPathGate) return gate.reason;
  }
  for (const CharacteristicResult& judged : producer.characteristics) {
    if (judged.verdict == Verdict::kVoid) return judged.reason;
  }
  return std::nullopt;
}

}  // namespace

core::Result<const FeatureResult*> producer_of(const std::string& id,
                                               std::span<const FeatureResult> earlier) {
  const auto found = std::ranges::find_if(
      earlier, [&](const FeatureResult& result) { return result.feature.id == id; });
  if (found == earlier.end()) {
    return core::fail(
        core::Code::kMeaning,
        core::phrase("it takes a value of feature {}, and no earlier feature has that "
                     "id",
                     id));
  }
  if (const auto why = why_void(*found)) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("it takes a value of feature {}, which is void: {}", id, *why));
  }
  return &*found;
}

Gate chain_gate(const std::string& producer, const std::optional<core::Phrase>& void_because) {
  Gate out;
  out.code = kChainVoid;
  out.condition = core::phrase("feature {} gives the value that this one takes", producer);
  if (!void_because) return out;
  out.outcome = Gate::Outcome::kVoids;
  out.reason = *void_because;
  return out;
}

std::optional<core::Phrase> chain_fault(const FeatureResult& result) {
  for (const Gate& gate : result.gates) {
    if (gate.code == kChainVoid && gate.outcome == Gate::Outcome::kVoids) return gate.reason;
  }
  return std::nullopt;
}

}  // namespace rondure::evaluation
