#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

namespace rondure::core {

/// What the program is at, for the person who waits: long computations say it, the terminal shows
/// it. There is one for the process, since it changes no result, and all computations would carry
/// it otherwise. All functions may be called from any thread.
class Watch {
 public:
  struct Work {
    std::string what;        ///< "evaluating 3 of 10: CYL A"; empty: nothing that takes long.
    std::size_t done = 0;    ///< Trials.
    std::size_t most = 0;    ///< Trials, at most; 0: there are none.
    std::size_t number = 0;  ///< Grows with each piece of work and each set of trials.
  };

  void begin(std::string what);
  /// The present work draws so many trials, at most.
  void expect(std::size_t trials);
  /// One trial is drawn.
  void drawn() { done_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] Work work() const;

 private:
  mutable std::mutex mutex_;
  Work work_;
  std::atomic<std::size_t> done_ = 0;
};

[[nodiscard]] Watch& watch();

/// A piece of work, from its beginning to its end.
class Working {
 public:
  explicit Working(std::string what) { watch().begin(std::move(what)); }
  ~Working() { watch().begin({}); }
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;
};

}  // namespace rondure::core
