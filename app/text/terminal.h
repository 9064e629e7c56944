#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "plans/run/runner.h"

namespace rondure::app {

/// Opens what the caller closed: else the first file of a run would take its place, and the summary
/// would be written into that file. From then on a file at its size limit gives an error, as a
/// full disk does, instead of a signal.
void hold_standard_streams();

/// Writes to standard output; whether that worked is asked once, by output_reached(). Control
/// characters become "?", but for line breaks, tabs and the colours of a chart.
void say(std::string_view text);
/// The same for one line that holds a name: a line break in it becomes "?" as well.
void say_line(std::string_view line);
/// Flushes standard output. False when not everything got there, after a message that says why.
[[nodiscard]] bool output_reached();

/// Writes one line to standard error, or a part without a line break at its end; control characters
/// of names and devices become "?". Never fails: a terminal that went away must not stop a machine.
void tell(std::string_view line);
/// Prints one line an error on standard error.
void print_error(const core::Error& error);
void print_error(const std::vector<core::Error>& errors);

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

/// Ctrl-C, SIGTERM and the end of the terminal ask the run to stop after the present touch; a
/// second signal ends the program at once. Every touch is on disk by then. From then on a pipe
/// whose reader went away does not end the program.
void listen_for_stop();
[[nodiscard]] bool stop_requested();
/// Asks for the same from within the program, in any thread.
void request_stop();

}  // namespace rondure::app
