#include "app/step_prompt.h"

#include <unistd.h>

#include <string>

#include <fmt/format.h>

#include "app/terminal.h"

namespace rondure::app {
namespace {

std::string place(const Eigen::Vector3d& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x(), p.y(), p.z());
}

std::string line_of(const plans::NextMove& move) {
  using Kind = plans::NextMove::Kind;
  if (move.kind == Kind::kHome || move.kind == Kind::kTurn) return move.what;
  return fmt::format("{} from {} to {} mm, {:.3f} mm", move.what, place(move.from_W_mm),
                     place(move.to_W_mm), (move.to_W_mm - move.from_W_mm).norm());
}

/// A line of standard input; "q" at its end and after a signal.
std::string answer() {
  std::string out;
  char c = 0;
  while (::read(STDIN_FILENO, &c, 1) == 1) {
    if (c == '\n' || c == '\r') return out;
    out += c;
  }
  return "q";
}

}  // namespace

core::Result<void> StepPrompt::check_terminal() {
  if (::isatty(STDIN_FILENO) == 1) return {};
  return core::fail(core::Code::kBadOption,
                    "--step asks before each move, but standard input is no terminal; run it from "
                    "one, or without --step");
}

core::Result<void> StepPrompt::ask(const plans::NextMove& move) {
  if (!asking_ && !stop_requested()) return {};
  while (!stop_requested()) {
    tell(line_of(move) + "\n  [Enter] go  [c] continue without asking  [q] stop: ");
    const std::string word = answer();
    if (word == "q") break;
    if (word == "c") asking_ = false;
    if (word.empty() || word == "c") return {};
  }
  return core::fail(core::Code::kStopped,
                    fmt::format("stopped by the operator before: {}", line_of(move)));
}

}  // namespace rondure::app
