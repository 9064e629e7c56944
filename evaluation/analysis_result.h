#pragma once

#include <variant>

#include "evaluation/contour/result.h"
#include "evaluation/rotary/result.h"
#include "evaluation/spindle/result.h"
#include "evaluation/wheel/result.h"

namespace rondure::evaluation {

/// What one analysis found of a feature: plain data, a struct each. Whoever judges or writes one
/// visits it. README.md says how to add one.
struct AnalysisResult {
  std::variant<SpindleResult, WheelResult, ContourResult, RotaryResult> found;
};

}  // namespace rondure::evaluation
