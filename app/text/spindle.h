#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/spindle/result.h"
#include "fit/spindle/probe_layout.h"

namespace rondure::app {

/// A three-probe separation as JSON (docs/spindle.md), and for a person.
[[nodiscard]] nlohmann::ordered_json spindle_json(const evaluation::SpindleResult& facts);
[[nodiscard]] std::string spindle_table(const evaluation::SpindleResult& facts);

/// Designed layouts with the two of the source and the reference beside them.
[[nodiscard]] nlohmann::ordered_json layouts_json(std::span<const fit::DesignedLayout> layouts,
                                                  const fit::LayoutSearch& search);
[[nodiscard]] std::string layouts_table(std::span<const fit::DesignedLayout> layouts,
                                        const fit::LayoutSearch& search);

}  // namespace rondure::app
