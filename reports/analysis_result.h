#pragma once

#include <variant>

#include "reports/contour_result.h"
#include "reports/rotary_result.h"
#include "reports/spindle_result.h"
#include "reports/wheel_result.h"

namespace rondure::reports {

/// What one analysis found of a feature: plain data, a struct each. Whoever judges or writes one
/// visits it. README.md says how to add one.
struct AnalysisResult {
  std::variant<SpindleResult, WheelResult, ContourResult, RotaryResult> found;
};

}  // namespace rondure::reports
