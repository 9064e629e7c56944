#include "app/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "core/units.h"

namespace rondure::app {
namespace {

volatile std::sig_atomic_t g_stop = 0;

extern "C" void on_stop(int /*signal*/) { g_stop = 1; }

std::string line_of(const plans::Progress& progress, double elapsed_s) {
  const std::size_t expected = std::max(progress.touches_expected, progress.touches);
  std::string out = fmt::format("{}  pose {} ({:.2f}, {:.2f}) deg  touch {}/{}", progress.feature,
                                progress.pose_number, progress.pose.alpha_rad / core::kDegree,
                                progress.pose.beta_rad / core::kDegree, progress.touches, expected);
  if (progress.f_mm) out += fmt::format("  f {:.1f} um", *progress.f_mm / core::kMicrometre);
  if (progress.touches > 0) {
    const double left = elapsed_s * static_cast<double>(expected - progress.touches) /
                        static_cast<double>(progress.touches);
    const auto seconds = static_cast<long>(left + 0.5);
    out += fmt::format("  left {}:{:02}", seconds / 60, seconds % 60);
  }
  return out;
}

}  // namespace

void complain(const core::Error& error) { fmt::print(stderr, "rondure: {}\n", core::to_line(error)); }

void complain(const std::vector<core::Error>& errors) {
  for (const core::Error& error : errors) fmt::print(stderr, "{}\n", core::to_line(error));
}

ProgressLine::ProgressLine(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressLine::show(const plans::Progress& progress) {
  if (!visible_) return;
  const auto now = Clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const std::string line = line_of(progress, std::chrono::duration<double>(now - start_).count());
  fmt::print(stderr, "\r{:.100}\x1b[K", line);
  std::fflush(stderr);
}

void listen_for_stop() {
  struct sigaction action = {};
  action.sa_handler = on_stop;
  action.sa_flags = SA_RESETHAND;  // the second one ends the program
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return g_stop != 0; }

}  // namespace rondure::app
