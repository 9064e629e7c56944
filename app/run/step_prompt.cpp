#include "app/run/step_prompt.h"

#include <unistd.h>

#include <fmt/format.h>

#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "core/units.h"

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

/// A line of standard input; "q" at the end of input and after a signal.
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

core::Result<void> StepPrompt::check_terminal(std::string_view what) {
  if (::isatty(STDIN_FILENO) == 1) return {};
  return core::fail_with(core::Code::kBadOption, "{}, but standard input is no terminal", what);
}

core::Result<void> StepPrompt::ask(const plans::NextMove& move) {
  if (!asking_ && !stop_requested()) return {};
  while (!stop_requested()) {
    tell(line_of(move) + "\n");
    tell("  [Enter] go  [c] continue without asking  [q] stop: ");
    const std::string word = answer();
    if (word == "q") break;
    if (word == "c") asking_ = false;
    if (word.empty() || word == "c") return {};
  }
  return core::fail_with(core::Code::kStopped, "stopped by the operator before: {}", line_of(move));
}

core::Result<void> ask_to_do(const std::string& what) {
  while (!stop_requested()) {
    tell(what + "\n");
    tell("  [Enter] done  [q] stop: ");
    const std::string word = answer();
    if (word.empty()) return {};
    if (word == "q") break;
  }
  return core::fail_with(core::Code::kStopped, "stopped by the operator before: {}", what);
}

core::Result<std::string> ask_a_person(const std::string& what) {
  if (auto terminal = StepPrompt::check_terminal(""); !terminal) {
    return core::fail_with(core::Code::kStopped,
                           "stopped, standard input is no terminal and nobody can answer; resume "
                           "the run from one: {}",
                           what);
  }
  TRY_DO(ask_to_do(what));
  return utc_now();
}

core::Result<void> ask_to_set(const core::Pose& pose) {
  return ask_to_do(fmt::format(
      "set the fixture by hand: alpha to {:.4f} deg and beta to {:.4f} deg (leave it if it stands "
      "there), clamp it and step back; the pose reached is measured",
      pose.alpha_rad / core::kDegree, pose.beta_rad / core::kDegree));
}

}  // namespace rondure::app
