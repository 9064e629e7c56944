#pragma once

#include <chrono>
#include <functional>

namespace rondure::app {

/// Slows a simulated run down for observers. The record is not affected.
class Pace {
 public:
  /// @param speed           Simulated seconds per second of real time; > 0.
  /// @param stop_requested  Ends the waiting.
  Pace(double speed, std::function<bool()> stop_requested);

  /// Waits until the wall clock has reached the machine's. The first call sets the start of both.
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
