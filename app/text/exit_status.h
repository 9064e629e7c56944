#pragma once

namespace rondure::app {

/// Exit status of the program (DESIGN, command line).
enum Exit : int {
  kAllWell = 0,  ///< Done; for run and report: everything conforms or is not toleranced.
  kNotConforming =
      1,  ///< Finished, but something does not conform, is undecided or void; verify: not equal.
  kBadInput = 2,   ///< Plan, file or arguments; verify: unreadable.
  kRunFailed = 3,  ///< Machine, fixture or run failed; recorded data are kept.
};

}  // namespace rondure::app
