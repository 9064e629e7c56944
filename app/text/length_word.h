#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::app {

/// Parses a length with its unit, as "1um", "0.5 um", "2e-3mm", "800nm", to mm.
/// @return  kBadOption: no unit, an unknown unit, no number, or not above 0; names the expected
///          form.
[[nodiscard]] core::Result<double> length_from(std::string_view word);

}  // namespace rondure::app
