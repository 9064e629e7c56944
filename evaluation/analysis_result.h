#pragma once

#include <variant>

#include "evaluation/contour/result.h"
#include "evaluation/five_axis/result.h"
#include "evaluation/rotary/result.h"
#include "evaluation/spindle/result.h"
#include "evaluation/wheel/result.h"

namespace rondure::evaluation {

/// The result of one analysis of a feature, as plain data: one struct per analysis. Judging and
/// writing code visits the variant. README.md explains how to add an analysis.
struct AnalysisResult {
  std::variant<SpindleResult, WheelResult, ContourResult, RotaryResult, FiveAxisResult> found;
};

}  // namespace rondure::evaluation
