#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "reports/evaluation.h"

// Private to the room: what report.json spells alike everywhere.

namespace rondure::reports {

/// The one place where lengths become micrometres and angles degrees.
[[nodiscard]] inline double in_um(double length_mm) { return length_mm * 1000.0; }
[[nodiscard]] inline double in_deg(double angle_rad) { return angle_rad / core::kDegree; }

[[nodiscard]] nlohmann::ordered_json optional_um(const std::optional<double>& length_mm);
[[nodiscard]] nlohmann::ordered_json error_json(const core::Error& error);
[[nodiscard]] nlohmann::ordered_json characteristic_json(const CharacteristicResult& result);

template <class Range, class Convert>
[[nodiscard]] nlohmann::ordered_json list_json(const Range& range, const Convert& convert) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& item : range) list.push_back(convert(item));
  return list;
}

}  // namespace rondure::reports
