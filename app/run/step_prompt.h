#pragma once

#include <string>
#include <string_view>

#include "core/pose.h"
#include "core/result.h"
#include "plans/run/runner.h"

namespace rondure::app {

/// Asks on the terminal before each motion of a first run: Enter goes, c goes on without asking, q
/// (also Ctrl-C and the end of input) stops in order.
class StepPrompt {
 public:
  /// kBadOption when standard input is no terminal: nobody could answer.
  /// @param what  Asks, for the message: "--step asks before each move".
  [[nodiscard]] static core::Result<void> check_terminal(std::string_view what);

  /// kStopped when the motion is not wanted.
  [[nodiscard]] core::Result<void> ask(const plans::NextMove& move);

 private:
  bool asking_ = true;
};

/// Asks somebody at the terminal to do something by hand: Enter says that it is done, q (also
/// Ctrl-C and the end of input) stops in order.
/// @return kStopped when it is not to be done.
[[nodiscard]] core::Result<void> ask_to_do(const std::string& what);

/// The same for a pose of a fixture that a hand sets.
[[nodiscard]] core::Result<void> ask_to_set(const core::Pose& pose);

}  // namespace rondure::app
