#pragma once

#include <string_view>

#include "core/result.h"

namespace rondure::cmm {

/// Parses the message of a Digimatic gauge at a Mitutoyo interface, without its CR: "01A+0000.123"
/// gives 0.123, in the unit that the gauge shows. kMachine for a status message ("911": no gauge,
/// or no data) and for anything else that is not a reading.
[[nodiscard]] core::Result<double> digimatic_reading(std::string_view message);

}  // namespace rondure::cmm
