#include "web/time.h"

#include <algorithm>

namespace rondure::web {

int predicted_touches(const std::vector<PredictedStage>& stages) {
  int sum = 0;
  for (const PredictedStage& stage : stages) sum += stage.touches;
  return sum;
}

double predicted_time_s(const std::vector<PredictedStage>& stages, double touches) {
  double time_s = 0.0;
  for (const PredictedStage& stage : stages) {
    const double share = stage.touches > 0 ? std::clamp(touches / stage.touches, 0.0, 1.0)
                                           : (touches > 0.0 ? 1.0 : 0.0);
    time_s += share * stage.time_s;
    touches -= stage.touches;
    if (touches <= 0.0) break;
  }
  return time_s;
}

std::optional<double> time_left_s(const std::vector<PredictedStage>& stages, int first, int touches,
                                  double elapsed_s) {
  constexpr int kForAPace = 3;
  const int all = predicted_touches(stages);
  if (touches < first + kForAPace || touches >= all) return std::nullopt;
  const double done_s = predicted_time_s(stages, touches) - predicted_time_s(stages, first);
  const double left_s = predicted_time_s(stages, all) - predicted_time_s(stages, touches);
  if (done_s <= 0.0) return std::nullopt;
  return left_s * elapsed_s / done_s;
}

}  // namespace rondure::web
