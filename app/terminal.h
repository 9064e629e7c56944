#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "core/error.h"
#include "plans/runner.h"

namespace rondure::app {

/// Prints one line an error on standard error.
void complain(const core::Error& error);
void complain(const std::vector<core::Error>& errors);

/// One line that follows a run on standard error: feature, pose, touches, f, time left. Silent when
/// standard error is no terminal. Redrawn ten times a second at most.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const plans::Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// Ctrl-C and SIGTERM ask the run to stop after the present touch; a second Ctrl-C ends the program
/// at once. Every touch is on disk by then.
void listen_for_stop();
[[nodiscard]] bool stop_requested();

}  // namespace rondure::app
