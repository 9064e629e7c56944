#include "app/text/terminal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/units.h"
#include "core/watch.h"
#include "record/files.h"

namespace rondure::app {
namespace {

std::atomic<int> g_stop = 0;  ///< Set by signals and by threads.
static_assert(std::atomic<int>::is_always_lock_free);
std::atomic<const char*> g_last_words = nullptr;  ///< Not null: a stop ends the program at once.
static_assert(std::atomic<const char*>::is_always_lock_free);
std::atomic<WaitingLine*> g_waiting = nullptr;
int g_output_error = 0;  ///< System error of the first failed write to standard output.

extern "C" void on_stop(int signal) {
  const char* const said = g_last_words;
  if (g_stop.exchange(1) == 0 && said == nullptr) return;
  if (said != nullptr) (void)!::write(STDERR_FILENO, said, std::strlen(said));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// "0:40"
std::string minutes(double time_s) {
  const auto seconds = static_cast<long>(time_s + 0.5);
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

/// "evaluating 3 of 10: CYL A, trial 1200 of 3000, about 0:40".
std::string line_of(const core::Watch::Work& work, double elapsed_s) {
  if (work.most == 0) return work.what;
  const std::size_t done = std::min(work.done, work.most);
  std::string out = fmt::format("{}, trial {} of {}", work.what, done, work.most);
  if (done == 0 || elapsed_s < 1.0) return out;
  const double left_s =
      elapsed_s * static_cast<double>(work.most - done) / static_cast<double>(done);
  return out + fmt::format(", about {}", minutes(left_s));
}

std::string line_of(const plans::Progress& progress, double elapsed_s) {
  if (progress.pose_number == 0) {
    return fmt::format("qualifying the probe  touch {}/{}", progress.touches,
                       progress.touches_expected);
  }
  const std::size_t expected = std::max(progress.touches_expected, progress.touches);
  std::string out = progress.feature;
  if (const auto& pose = progress.pose) {
    out += fmt::format("  pose {} ({:.2f}, {:.2f}) deg", progress.pose_number,
                       pose->alpha_rad / core::kDegree, pose->beta_rad / core::kDegree);
  }
  out += fmt::format("  touch {}/{}", progress.touches, expected);
  if (progress.f_mm) out += fmt::format("  f {:.1f} um", *progress.f_mm / core::kMicrometre);
  if (progress.touches > 0) {
    const double left = elapsed_s * static_cast<double>(expected - progress.touches) /
                        static_cast<double>(progress.touches);
    out += fmt::format("  left {}", minutes(left));
  }
  return out;
}

/// Text without control characters, except line breaks, tabs and the colours of the program's
/// charts: an escape sequence in a name must not reach the terminal.
std::string without_controls(std::string_view text) {
  constexpr std::array<std::string_view, 2> kColours = {"\x1b[31m", "\x1b[0m"};
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view rest = text.substr(i);
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto* colour = std::find_if(kColours.begin(), kColours.end(),
                                      [&](std::string_view c) { return rest.starts_with(c); });
    // U+0080..9F are controls too, which some terminals obey.
    const bool high = byte == 0xC2 && rest.size() > 1 && static_cast<unsigned char>(rest[1]) < 0xA0;
    if (colour != kColours.end()) {
      out += *colour;
      i += colour->size() - 1;
    } else if (high || byte == 0x7F || (byte < 0x20 && byte != '\n' && byte != '\t')) {
      out += '?';
      i += high ? 1 : 0;
    } else {
      out += text[i];
    }
  }
  return out;
}

void write_to_terminal(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

void hide_waiting() {
  if (WaitingLine* const line = g_waiting) line->hide();
}

}  // namespace

void hold_standard_streams() {
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) >= 0) continue;
    // Read-only for standard output: writes to it fail and are reported as lost. The lowest free
    // number is the one that was closed.
    (void)open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void say(std::string_view text) {
  hide_waiting();
  const std::string safe = without_controls(text);
  if (std::fwrite(safe.data(), 1, safe.size(), stdout) != safe.size()) g_output_error = errno;
}

void say_line(std::string_view line) { say(core::printable(line) + "\n"); }

bool output_reached() {
  if (std::fflush(stdout) != 0 && g_output_error == 0) g_output_error = errno;
  if (g_output_error == 0 && std::ferror(stdout) == 0 && std::cout.good()) return true;
  const std::string reason = g_output_error == EBADF ? "it is closed"
                             : g_output_error == 0   ? "an earlier part of it was lost"
                                                     : record::system_reason(g_output_error);
  tell(fmt::format("rondure: cannot write to standard output: {}\n", reason));
  return false;
}

void tell(std::string_view line) {
  hide_waiting();
  const bool ends = line.ends_with('\n');
  if (ends) line.remove_suffix(1);
  write_to_terminal(core::printable(line) + (ends ? "\n" : ""));
}

void print_error(const core::Error& error) {
  // The sentence may contain the file name already.
  const bool named = error.what.find(error.where) != std::string::npos;
  tell(fmt::format("rondure: {}\n", core::to_line(named ? error.at({}) : error)));
}

void print_error(const std::vector<core::Error>& errors) {
  for (const core::Error& error : errors) tell(core::to_line(error) + "\n");
}

ProgressLine::ProgressLine(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) write_to_terminal("\r\x1b[K");
}

void ProgressLine::show(const plans::Progress& progress) {
  if (!visible_) return;
  const auto now = Clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  write_to_terminal(fmt::format("\r{:.100}\x1b[K", core::printable(line_of(progress, elapsed_s))));
}

WaitingLine::WaitingLine(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) != 1) return;
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
    g_waiting = this;
  } catch (const std::system_error&) {  // no thread to be had: no line
  }
}

WaitingLine::~WaitingLine() {
  thread_ = {};
  hide();
  g_waiting = nullptr;
}

void WaitingLine::hide() {
  const std::scoped_lock lock(mutex_);
  if (std::exchange(drawn_, false)) write_to_terminal("\r\x1b[K");
}

void WaitingLine::watch(const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point busy_since = Clock::now();
  Clock::time_point trials_since = busy_since;
  std::size_t number = 0;
  std::unique_lock lock(mutex_);
  while (!woken_.wait_for(lock, stop, std::chrono::milliseconds(200),
                          [&stop] { return stop.stop_requested(); })) {
    const core::Watch::Work work = core::watch().work();
    const auto now = Clock::now();
    if (std::exchange(number, work.number) != work.number) trials_since = now;
    if (work.what.empty()) busy_since = now;
    if (now - busy_since < std::chrono::seconds(1)) continue;
    drawn_ = true;
    const double elapsed_s = std::chrono::duration<double>(now - trials_since).count();
    write_to_terminal(fmt::format("\r{:.79}\x1b[K", core::printable(line_of(work, elapsed_s))));
  }
}

StopsAtOnce::StopsAtOnce(std::string said) : said_(std::move(said)) {
  g_last_words = said_.c_str();
}

StopsAtOnce::~StopsAtOnce() { g_last_words = nullptr; }

void listen_for_stop() {
  struct sigaction action = {};
  action.sa_handler = on_stop;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present = {};
    sigaction(signal, nullptr, &present);
    // a process under nohup keeps ignoring the signal
    if (present.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  // The reader of the output may end first, by the same Ctrl-C in a pipe: the run still ends in
  // order.
  std::signal(SIGPIPE, SIG_IGN);
}

bool stop_requested() { return g_stop != 0; }

void request_stop() { g_stop = 1; }

}  // namespace rondure::app
