#pragma once

#include "core/result.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

struct WheelResult;  // wheel/result.h

/// The wheel whose path over its surface may reach a machine: `evaluation.path` is there.
///
/// @return  Owned by `result`; or why no path may leave the run: no result, a gate that voids, no
///          surface, a path that is refused, a radius that proves nothing, a characteristic that is
///          void or does not conform.
[[nodiscard]] core::Result<const WheelResult*> wheel_for_path(const FeatureResult& result);

}  // namespace rondure::evaluation
