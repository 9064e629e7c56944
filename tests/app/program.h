#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/scratch.h"

namespace rondure::app::testing {

using test::Scratch;

/// Starts the program in a child that has called `enter` before; its process id.
[[nodiscard]] pid_t start(const std::vector<std::string>& arguments,
                          const std::function<void()>& enter);

/// Conditions under which the program is started.
struct Surroundings {
  std::optional<std::size_t> largest_file_bytes;  ///< Like a full disk: writes beyond it fail.
  /// Empty: captured; "closed"; "unread": with standard error a pipe without a reader; else a file
  /// to write to.
  std::string standard_output;
  bool empty_environment = false;
  bool unprivileged = false;  ///< Runs as user `nobody` when the tests run as root.
};

/// Exit and output of the program.
struct Outcome {
  int status = -1;  ///< Exit status; -1 when a signal ended it.
  int signal = 0;   ///< The signal that ended it, or 0.
  std::string out;  ///< Standard output.
  std::string err;  ///< Standard error.
};

/// A running program.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments,
                   const Surroundings& surroundings = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Sends a signal; has no effect after wait().
  void send(int signal) const;
  [[nodiscard]] bool ended() const;
  [[nodiscard]] Outcome wait();
  /// Standard error so far.
  [[nodiscard]] std::string told() const;

 private:
  Scratch folder_;  ///< Holds the output of the program.
  pid_t pid_ = -1;
};

/// Runs the program to its end.
[[nodiscard]] Outcome rondure(const std::vector<std::string>& arguments,
                              const Surroundings& surroundings = {});

}  // namespace rondure::app::testing
