#pragma once

#include <span>
#include <string>

#include "fit/contour_study.h"

namespace rondure::app {

/// A study of crank pins as JSON (docs/contour.md), one line feed at the end.
/// @param names  One a part.
[[nodiscard]] std::string contour_json(const fit::ContourStudy& study,
                                       const fit::ContourStudyOptions& options,
                                       std::span<const std::string> names);
/// The same for a person.
[[nodiscard]] std::string contour_table(const fit::ContourStudy& study,
                                        const fit::ContourStudyOptions& options,
                                        std::span<const std::string> names);

}  // namespace rondure::app
