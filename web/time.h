#pragma once

#include <optional>
#include <vector>

namespace rondure::web {

/// A stage of the run in the plan's time model, in the order of the run.
struct PredictedStage {
  int touches = 0;
  double time_s = 0.0;  ///< Time of the machine clock.
};

/// Total touches of all stages.
[[nodiscard]] int predicted_touches(const std::vector<PredictedStage>& stages);

/// Predicted time from the start to the end of touch `touches` [s]; within a stage proportional to
/// its touches.
[[nodiscard]] double predicted_time_s(const std::vector<PredictedStage>& stages, double touches);

/// Time left: the predicted time of the remaining touches, at the pace of the run since the first
/// touch of this program start (1 on a machine that behaves as predicted; far less in a simulation
/// without waiting).
/// @param first     Touches on record at the first touch of this program start.
/// @param elapsed_s Time since then.
/// @return  None without a model, before the pace is known (three touches), and after the last
///          predicted touch.
[[nodiscard]] std::optional<double> time_left_s(const std::vector<PredictedStage>& stages,
                                                int first, int touches, double elapsed_s);

}  // namespace rondure::web
