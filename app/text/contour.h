#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "fit/contour/study.h"

namespace rondure::app {

/// A study of crank pins as JSON (docs/contour.md).
/// @param names  One per part.
[[nodiscard]] nlohmann::ordered_json contour_json(const fit::ContourStudy& study,
                                                  const fit::ContourStudyOptions& options,
                                                  std::span<const std::string> names);
/// A study of crank pins as a table.
[[nodiscard]] std::string contour_table(const fit::ContourStudy& study,
                                        const fit::ContourStudyOptions& options,
                                        std::span<const std::string> names);

}  // namespace rondure::app
