#pragma once

#include <cstddef>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::web {

/// For a cloud with more touches, only every k-th point of a layer is evaluated.
inline constexpr std::size_t kMostLiveTouches = 2000;

/// The recorded part of the cloud of one pose, evaluated like a final cloud but without verdicts
/// and uncertainty: the input of the report's drawings.
struct LiveCloud {
  evaluation::FeatureResult result;
  std::size_t every = 1;  ///< Only every `every`-th point was evaluated.
};

/// @return  kNoPoints and the other codes of a fit: the touches do not define the feature yet;
///          kBadOption: an analysis, which has no cloud.
[[nodiscard]] core::Result<LiveCloud> evaluate_so_far(const record::RunRecord& record,
                                                      const record::PoseVisit& visit);

}  // namespace rondure::web
