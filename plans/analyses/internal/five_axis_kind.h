#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/result.h"
#include "plans/analyses/analysis.h"

namespace rondure::plans {

/// The words of the column "step", in the order of fit::HeadStep.
inline constexpr std::array<std::string_view, 4> kHeadSteps = {"reference", "C", "A",
                                                               "verification"};

/// AnalysisKind::simulate of the type five_axis.
[[nodiscard]] core::Result<AnalysisData> simulate_five_axis(const Plan& plan, std::size_t index,
                                                            std::uint64_t seed, bool errors);

}  // namespace rondure::plans
