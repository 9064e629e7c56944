#include "app/run/pace.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace rondure::app {

Pace::Pace(double speed, std::function<bool()> stop_requested)
    : speed_(speed), stop_requested_(std::move(stop_requested)), start_(Clock::now()) {}

void Pace::keep(double machine_time_s) {
  constexpr auto kLook = std::chrono::milliseconds(20);  // how soon a stop is seen
  if (!begun_) {
    begun_ = true;
    first_s_ = machine_time_s;
    start_ = Clock::now();
  }
  const std::chrono::duration<double> due((machine_time_s - first_s_) / speed_);
  while (!stop_requested_()) {
    const std::chrono::duration<double> left = due - (Clock::now() - start_);
    if (left.count() <= 0.0) return;
    std::this_thread::sleep_for(std::min<std::chrono::duration<double>>(left, kLook));
  }
}

}  // namespace rondure::app
