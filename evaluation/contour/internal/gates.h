#pragma once

#include <span>
#include <vector>

#include "evaluation/contour/result.h"
#include "evaluation/results/gate.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The gate of recorded positions of X: stroke and course against the geometry. It needs no study,
/// which refuses contradicting positions.
[[nodiscard]] std::vector<Gate> position_gates(std::span<const fit::ContourPart> parts,
                                               const fit::ContourStudyOptions& options);

/// The gate of a study that could not be made, if its error is one of the traces; otherwise none.
[[nodiscard]] std::vector<Gate> failed_gates(const core::Error& error);

/// All other gates of a study, passed or not. Those that void a curve fill `facts.total_void`,
/// `following_void` and `rest_void`.
/// @param asked  Their tolerances limit the eccentricity.
[[nodiscard]] std::vector<Gate> contour_gates(std::span<const record::Characteristic> asked,
                                              ContourResult& facts);

/// Whether a warning of the study is a gate here, which says it in its place.
[[nodiscard]] bool is_gate(const core::Error& warning, const fit::ContourStudyOptions& options);

}  // namespace rondure::evaluation
