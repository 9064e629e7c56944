#include "evaluation/uncertainty/statement.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace rondure::evaluation {

int decimals_for(double expanded_mm) {
  const double u = expanded_mm / core::kMicrometre;
  if (!(u > 0.0)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 1, 4);
}

}  // namespace rondure::evaluation
