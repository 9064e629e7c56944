#pragma once

#include <string>
#include <string_view>

#include "core/pose.h"
#include "core/result.h"
#include "plans/run/runner.h"

namespace rondure::app {

/// Asks on the terminal before each motion of a first run: Enter makes the motion, c continues
/// without asking, q (also Ctrl-C and the end of input) stops the run in an orderly manner.
class StepPrompt {
 public:
  /// kBadOption when standard input is not a terminal: nobody could answer.
  /// @param what  Subject of the message: "--step asks before each move".
  [[nodiscard]] static core::Result<void> check_terminal(std::string_view what);

  /// Asks before a motion. kStopped when it is refused.
  [[nodiscard]] core::Result<void> ask(const plans::NextMove& move);

 private:
  bool asking_ = true;
};

/// Asks the user to do something by hand: Enter confirms it, q (also Ctrl-C and the end of input)
/// stops the run in an orderly manner.
/// @return kStopped when the user refuses.
[[nodiscard]] core::Result<void> ask_to_do(const std::string& what);

/// ask_to_do() for a step between two features. Returns the time of the answer (UTC);
/// kStopped, too, where standard input is no terminal.
[[nodiscard]] core::Result<std::string> ask_a_person(const std::string& what);

/// ask_to_do() for a pose of a fixture that is set by hand.
[[nodiscard]] core::Result<void> ask_to_set(const core::Pose& pose);

}  // namespace rondure::app
