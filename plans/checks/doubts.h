#pragma once

#include <vector>

#include "core/error.h"
#include "plans/plan.h"

namespace rondure::plans {

/// What a valid plan says although hardly anybody means it, each with its pointer: a limit that is
/// a thousand times too small, as one in mm under a key in um; a datum that locks nothing; a body
/// with gaps. The plan runs as it stands.
[[nodiscard]] std::vector<core::Error> doubts_of(const Plan& plan);

}  // namespace rondure::plans
