#pragma once

#include "plans/plan.h"
#include "record/tasks/feature_reference.h"

namespace rondure::plans {

/// The wheel that a simulated feature names for its radius.
struct NamedWheel {
  double nominal_mm = 0.0;  ///< As its feature states it.
  /// Of the simulated body at speed, the circle that its edge sweeps; the nominal one where points
  /// of the wheel come from a file, as nothing else is known before they are evaluated.
  double true_mm = 0.0;
};

/// @pre The plan is checked: the feature is a wheel of mode envelope with a nominal radius.
[[nodiscard]] NamedWheel named_wheel(const Plan& plan, const record::FeatureReference& from);

}  // namespace rondure::plans
