#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

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

/// The state of a run from which the parts of the page are written. All text of the record is
/// escaped.
struct LiveNow {
  const record::PoseVisit* pose = nullptr;  ///< The current pose; null before the first.
  std::optional<evaluation::PoseValue> f;   ///< For the touches so far in the current pose.
  std::optional<double> zone_mm;            ///< Minimum zone of these touches.
  std::size_t expected = 0;                 ///< Predicted touches of the run; 0: unknown.
  double elapsed_s = 0.0;
  std::optional<double> left_s;
};

/// "Measuring feature bore, pose 3": changes only with the pose and the state.
[[nodiscard]] std::string live_doing(const record::RunRecord& record, const LiveNow& now);
/// The current numbers.
[[nodiscard]] std::string live_numbers(const record::RunRecord& record, const LiveNow& now);
/// The drawings of the report for the current cloud.
[[nodiscard]] std::string live_drawings(const core::Result<LiveCloud>& cloud);
/// The last touches, the newest first.
[[nodiscard]] std::string live_touches(const record::RunRecord& record);
/// Heading of the page after the run, above the verdict.
[[nodiscard]] std::string live_over(const record::RunRecord& record, std::string_view report);

}  // namespace rondure::web
