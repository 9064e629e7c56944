#pragma once

#include <optional>
#include <vector>

namespace rondure::web {

/// A stage of the run as the plan's time model predicts it, in the order of the run.
struct PredictedStage {
  int touches = 0;
  double time_s = 0.0;  ///< By the machine's clock.
};

/// Touches of all stages.
[[nodiscard]] int predicted_touches(const std::vector<PredictedStage>& stages);

/// Predicted time from the start to the end of touch `touches` [s]; within a stage in proportion to
/// its touches.
[[nodiscard]] double predicted_time_s(const std::vector<PredictedStage>& stages, double touches);

/// Time left: what the model predicts for the touches that are still to come, at the pace the run
/// has had since its first touch of this start (1 on a machine that does as predicted; far less
/// where a simulation does not wait).
/// @param first     Touches on record when this start of the program made its first one.
/// @param elapsed_s Since then.
/// @return  Nothing without a model, before a pace is known (three touches), and after the last
///          touch that was predicted.
[[nodiscard]] std::optional<double> time_left_s(const std::vector<PredictedStage>& stages,
                                                int first, int touches, double elapsed_s);

}  // namespace rondure::web
