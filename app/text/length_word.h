#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::app {

/// A length with its unit, as "1um", "0.5 um", "2e-3mm", "800nm", in mm.
/// @return  kBadOption: no unit, another unit, no number, or not above 0; says what to write.
[[nodiscard]] core::Result<double> length_from(std::string_view word);

}  // namespace rondure::app
