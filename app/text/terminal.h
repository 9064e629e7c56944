#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/error.h"
#include "plans/run/runner.h"

namespace rondure::app {

/// Opens standard streams that the caller has closed: otherwise the first file of a run would get a
/// stream's number, and the summary would be written into it. Also makes a file at its size limit
/// give an error, like a full disk, instead of a signal.
void hold_standard_streams();

/// Writes to standard output; output_reached() reports failures once. Control characters become
/// "?", except line breaks, tabs and the colours of a chart.
void say(std::string_view text);
/// say() for one line that contains a name: a line break in it becomes "?" as well.
void say_line(std::string_view line);
/// Flushes standard output. False, after a message with the cause, when not all output was written.
[[nodiscard]] bool output_reached();

/// Writes one line to standard error, or a part of one without line break; control characters in
/// names from files and devices become "?". Never fails: a closed terminal must not stop a machine.
void tell(std::string_view line);
/// Prints an error on standard error, in one line.
void print_error(const core::Error& error);
void print_error(const std::vector<core::Error>& errors);

/// A status line of a run on standard error: feature, pose, touches, f, time left. Not shown when
/// standard error is not a terminal. Redrawn at most ten times a second.
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

/// A status line for everything that takes longer than a second or two: what the program is at
/// (core::watch()), the trial, the time left. Not shown when standard error is not a terminal.
/// say() and tell() remove it before they write.
class WaitingLine {
 public:
  explicit WaitingLine(bool quiet);
  ~WaitingLine();
  WaitingLine(const WaitingLine&) = delete;
  WaitingLine& operator=(const WaitingLine&) = delete;

  void hide();

 private:
  void watch(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any woken_;
  bool drawn_ = false;
  std::jthread thread_;
};

/// Installs signal handlers: Ctrl-C, SIGTERM and the end of the terminal ask the run to stop after
/// the current touch; a second signal ends the program at once. Every touch is on disk by then. A
/// pipe whose reader has closed it no longer ends the program.
void listen_for_stop();
[[nodiscard]] bool stop_requested();
/// Requests the same stop from within the program; callable from any thread.
void request_stop();

/// While it exists, already the first signal ends the program at once, after `said`: for work that
/// can be done again from what is on disk.
class StopsAtOnce {
 public:
  explicit StopsAtOnce(std::string said);
  ~StopsAtOnce();
  StopsAtOnce(const StopsAtOnce&) = delete;
  StopsAtOnce& operator=(const StopsAtOnce&) = delete;

 private:
  std::string said_;
};

}  // namespace rondure::app
