#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "fit/contour/study.h"

namespace rondure::app {

/// A study of crank pins as JSON (docs/contour.md).
/// @param names  One a part.
[[nodiscard]] nlohmann::ordered_json contour_json(const fit::ContourStudy& study,
                                                  const fit::ContourStudyOptions& options,
                                                  std::span<const std::string> names);
/// The same for a person.
[[nodiscard]] std::string contour_table(const fit::ContourStudy& study,
                                        const fit::ContourStudyOptions& options,
                                        std::span<const std::string> names);

}  // namespace rondure::app
