#include "core/watch.h"

namespace rondure::core {

void Watch::begin(std::string what) {
  const std::scoped_lock lock(mutex_);
  work_ = {std::move(what), 0, 0, work_.number + 1};
  done_ = 0;
}

void Watch::expect(std::size_t trials) {
  const std::scoped_lock lock(mutex_);
  work_.most = trials;
  ++work_.number;
  done_ = 0;
}

Watch::Work Watch::work() const {
  const std::scoped_lock lock(mutex_);
  Work now = work_;
  now.done = done_;
  return now;
}

Watch& watch() {
  static Watch one;
  return one;
}

}  // namespace rondure::core
