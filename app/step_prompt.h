#pragma once

#include "core/result.h"
#include "plans/runner.h"

namespace rondure::app {

/// Asks on the terminal before each motion of a first run: Enter goes, c goes on without asking, q
/// (also Ctrl-C and the end of input) stops in order.
class StepPrompt {
 public:
  /// kBadOption when standard input is no terminal: nobody could answer.
  [[nodiscard]] static core::Result<void> check_terminal();

  /// kStopped when the motion is not wanted.
  [[nodiscard]] core::Result<void> ask(const plans::NextMove& move);

 private:
  bool asking_ = true;
};

}  // namespace rondure::app
