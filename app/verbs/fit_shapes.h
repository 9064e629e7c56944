#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "app/text/fit.h"
#include "core/result.h"

namespace rondure::app {

/// Fits the requested references of a shape. A reference that does not exist for the points is
/// empty in the outcome, with a warning that gives the reason.
///
/// @param shape      "circle" (z is not used), "cylinder", "sphere", "line".
/// @param reference  "ls", "mz", "mc", "mi" or "all"; a line has "ls" and "mz".
/// @return Why the points cannot be fitted at all.
[[nodiscard]] core::Result<FitOutcome> fit_shape(const std::string& shape,
                                                 const std::string& reference,
                                                 std::span<const Eigen::Vector3d> points_mm);

}  // namespace rondure::app
