#include "evaluation/decision/verdict.h"

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

}  // namespace rondure::evaluation
