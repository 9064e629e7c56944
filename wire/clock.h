#pragma once

#include <chrono>
#include <thread>

namespace rondure::wire {

/// The time that a device and its driver live in. A driver that waits asks it, so that a test can
/// let hours pass in no time.
class Clock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  virtual ~Clock() = default;
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  [[nodiscard]] virtual Time now() const = 0;
  virtual void sleep_for(std::chrono::milliseconds time) = 0;
};

/// The time of the world.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return std::chrono::steady_clock::now(); }
  void sleep_for(std::chrono::milliseconds time) override { std::this_thread::sleep_for(time); }
};

/// The one that is used where none is given.
[[nodiscard]] inline Clock& system_clock() {
  static SystemClock clock;
  return clock;
}

}  // namespace rondure::wire
