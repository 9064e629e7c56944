#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "fit/contour/study.h"

namespace rondure::reports {

/// A study of crank pins as JSON, keys in their published order (docs/contour.md): a contour
/// feature in report.json.
/// @param names  One per part.
[[nodiscard]] nlohmann::ordered_json contour_document(const fit::ContourStudy& study,
                                                      const fit::ContourStudyOptions& options,
                                                      std::span<const std::string> names);

/// How f was found: "direct" from the traces of the axes, "indirect" from the main journals.
[[nodiscard]] const char* separation_of(const fit::ContourStudy& study);

/// Conclusions from the stability indices, one sentence each; below 4 parts one sentence that there
/// are too few.
[[nodiscard]] std::vector<core::Phrase> contour_verdicts(const fit::ContourStudy& study);

}  // namespace rondure::reports
