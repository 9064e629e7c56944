#pragma once

#include "plans/plan.h"

// Requirements of the features of a plan.

namespace rondure::plans {

/// Whether a feature is a surface touched by a machine: neither points from a file nor an analysis.
[[nodiscard]] bool is_touched(const FeaturePlan& feature);
/// Whether anything of a plan is simulated.
[[nodiscard]] bool simulates_anything(const Plan& plan);
/// Whether the series of a feature are simulated, which is also possible with a real machine.
[[nodiscard]] bool simulates_analysis(const Plan& plan);
/// Whether a feature needs the machine: a touched surface, or balls.
[[nodiscard]] bool needs_machine(const FeaturePlan& feature);
/// Whether a plan needs a machine.
[[nodiscard]] bool touches_anything(const Plan& plan);

}  // namespace rondure::plans
