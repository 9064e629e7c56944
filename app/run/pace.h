#pragma once

#include <chrono>
#include <functional>

namespace rondure::app {

/// Lets a simulated run take time, so that somebody can watch it. The record knows nothing of it.
class Pace {
 public:
  /// @param speed           Seconds of the simulated machine in one of the wall; > 0.
  /// @param stop_requested  Ends the waiting.
  Pace(double speed, std::function<bool()> stop_requested);

  /// Waits until the wall clock is as far as the machine's. What the machine's clock shows first is
  /// the beginning.
  void keep(double machine_time_s);

 private:
  using Clock = std::chrono::steady_clock;
  double speed_;
  std::function<bool()> stop_requested_;
  bool begun_ = false;
  double first_s_ = 0.0;
  Clock::time_point start_;
};

}  // namespace rondure::app
