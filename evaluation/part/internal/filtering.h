#pragma once

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "record/indication.h"

// Private to the room: filters of prepared surfaces (drawing, 6 and 7).

namespace rondure::evaluation {

/// Whether warnings are looked for: a trial needs none.
enum class Warnings { kSkip, kFind };

/// Filters the points of a surface round each section about its circle, so that its eccentricity
/// stays as it is, and along the axis where a cut-off in mm is asked for. Sets `filter` and
/// `dense`.
/// @return kSampling where the sections do not carry the filter; kMeaning for a shape or a window
///         that this filter does not know.
[[nodiscard]] core::Result<void> filter(PreparedSurface& surface,
                                        const record::Indication& indication, Warnings warnings);

}  // namespace rondure::evaluation
