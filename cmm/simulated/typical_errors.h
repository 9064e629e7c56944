#pragma once

#include "cmm/error_model.h"

namespace rondure::cmm {

/// Errors of a good bridge machine of about 1 m with a kinematic touch-trigger probe, in a
/// measuring room. Values and their sources: docs/simulation.md. The repeatability and the ball are
/// ideal: they belong to the probe described in a plan.
[[nodiscard]] MachineErrors typical_errors();

}  // namespace rondure::cmm
