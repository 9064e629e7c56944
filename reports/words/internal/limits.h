#pragma once

#include <optional>

#include "core/numbers.h"
#include "core/units.h"

namespace rondure::reports {

/// A limit in `unit` as the plan states it, to 1e-9 of the unit. The sum of a nominal diameter and
/// a deviation, and um that became mm, differ from the plan in their last digits.
[[nodiscard]] inline std::optional<double> limit_in(core::ValueUnit unit,
                                                    const std::optional<double>& limit_mm) {
  constexpr double kStepsPerUnit = 1e9;
  if (!limit_mm) return std::nullopt;
  const double limit = unit == core::ValueUnit::kMm ? *limit_mm : core::micrometres(*limit_mm);
  return core::on_grid(limit, kStepsPerUnit);
}

}  // namespace rondure::reports
