#pragma once

#include <span>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "fit/geometry/axis.h"
#include "record/tasks/indication.h"

// Private to the room: filters of prepared surfaces (drawing, 6 and 7).

namespace rondure::evaluation {

/// Whether a section carries the lowest usual cut-off, 15 UPR: it may then be read as a profile.
/// @param gap  Windows take a part of the turn: gaps above 1.5 times the median one do not count.
[[nodiscard]] bool carries_lowest_cutoff(std::span<const Eigen::Vector3d> points_mm,
                                         const fit::Axis& axis, bool gap);

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
