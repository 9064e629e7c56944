#include "evaluation/correction/wheel_path.h"

#include "evaluation/analysis_result.h"
#include "evaluation/correction/internal/barred.h"

namespace rondure::evaluation {

core::Result<const WheelResult*> wheel_for_path(const FeatureResult& result) {
  using core::Code;
  if (auto why = barred(result)) return core::fail(Code::kMeaning, *std::move(why));
  const auto& facts = std::get<WheelResult>(result.analysis->found);
  const fit::WheelEvaluation& found = facts.evaluation;
  if (found.refused) return core::fail(*found.refused);
  if (!found.path) {
    return core::fail(Code::kMeaning, "no surface is to be ground (wheel.surface)");
  }
  if (!found.wheel.radius_void_because.empty()) {
    return core::fail(Code::kMeaning, found.wheel.radius_void_because);
  }
  for (const CharacteristicResult& c : result.characteristics) {
    if (c.verdict != Verdict::kVoid && c.verdict != Verdict::kDoesNotConform) continue;
    return core::fail_with(Code::kMeaning, "{} {}: {}", c.characteristic.id, name_of(c.verdict),
                           c.reason.english());
  }
  return &facts;
}

}  // namespace rondure::evaluation
