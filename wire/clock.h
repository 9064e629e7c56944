#pragma once

#include <chrono>
#include <thread>

namespace rondure::wire {

/// The clock of a device and its driver. A driver that waits uses this clock, so that a test can
/// simulate hours without waiting.
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

/// The clock of the computer.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return std::chrono::steady_clock::now(); }
  void sleep_for(std::chrono::milliseconds time) override { std::this_thread::sleep_for(time); }
};

/// The default clock.
[[nodiscard]] inline Clock& system_clock() {
  static SystemClock clock;
  return clock;
}

}  // namespace rondure::wire
