#include "reports/words/internal/truths.h"

#include <cstddef>

#include "evaluation/results/finding.h"

namespace rondure::reports {

std::vector<HeldAgainstTruth> held_against_truth(const evaluation::CharacteristicResult& result) {
  std::vector<HeldAgainstTruth> out;
  for (std::size_t k = 0; result.value && k < result.truths_mm.size(); ++k) {
    HeldAgainstTruth one{result.characteristic.id, *result.value, result.truths_mm[k]};
    if (result.finding) {
      const auto& judged = result.finding->judged;
      if (judged.size() > 1) one.name += " " + judged[k].symbol;
      one.found = result.value->moved_to(judged[k].value_mm);
    }
    if (const auto* stated = one.found.statement()) one.u_mm = stated->standard_uncertainty_mm;
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<HeldAgainstTruth> held_against_truth(const evaluation::FeatureResult& feature) {
  std::vector<HeldAgainstTruth> out;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    for (HeldAgainstTruth& one : held_against_truth(result)) out.push_back(std::move(one));
  }
  return out;
}

}  // namespace rondure::reports
