#include "evaluation/decision/verdict.h"

#include <algorithm>
#include <array>

namespace rondure::evaluation {

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kConforms:
      return "conforms";
    case Verdict::kDoesNotConform:
      return "does not conform";
    case Verdict::kUndecided:
      return "undecided";
    case Verdict::kVoid:
      return "void";
    case Verdict::kNotToleranced:
      return "not toleranced";
  }
  return "void";
}

int severity(Verdict verdict) {
  constexpr std::array kOrder = {Verdict::kNotToleranced, Verdict::kConforms, Verdict::kUndecided,
                                 Verdict::kVoid, Verdict::kDoesNotConform};
  return static_cast<int>(std::find(kOrder.begin(), kOrder.end(), verdict) - kOrder.begin());
}

}  // namespace rondure::evaluation
