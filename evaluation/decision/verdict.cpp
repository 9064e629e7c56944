#include "evaluation/decision/verdict.h"

#include <algorithm>
#include <array>

namespace rondure::evaluation {

int severity(Verdict verdict) {
  constexpr std::array kOrder = {Verdict::kNotToleranced, Verdict::kConforms, Verdict::kUndecided,
                                 Verdict::kVoid, Verdict::kDoesNotConform};
  return static_cast<int>(std::find(kOrder.begin(), kOrder.end(), verdict) - kOrder.begin());
}

}  // namespace rondure::evaluation
