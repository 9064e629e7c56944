#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "fit/spindle/probe_layout.h"
#include "reports/spindle_result.h"

namespace rondure::app {

/// A three-probe separation as JSON (docs/spindle.md), and as a table.
[[nodiscard]] nlohmann::ordered_json spindle_json(const reports::SpindleFacts& facts);
[[nodiscard]] std::string spindle_table(const reports::SpindleFacts& facts);

/// Designed layouts with the two of the source and the reference beside them.
[[nodiscard]] nlohmann::ordered_json layouts_json(std::span<const fit::DesignedLayout> layouts,
                                                  const fit::LayoutSearch& search);
[[nodiscard]] std::string layouts_table(std::span<const fit::DesignedLayout> layouts,
                                        const fit::LayoutSearch& search);

}  // namespace rondure::app
