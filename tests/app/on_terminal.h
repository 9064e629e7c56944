#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace rondure::app::testing {

/// The program with a terminal as its standard input and outputs.
class OnTerminal {
 public:
  /// @param locale  Value of LC_ALL for the program; empty: that of the test.
  explicit OnTerminal(const std::vector<std::string>& arguments, const std::string& locale = {});
  ~OnTerminal();
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void type(const std::string& keys) const;
  /// Reads until `text` is shown after the last text that was waited for; false at the end of the
  /// program or after 20 s.
  [[nodiscard]] bool wait_for(const std::string& text);
  /// Reads to the end; returns the exit status, -1 when a signal ended the program.
  int finish();
  /// Everything shown so far.
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  bool read_some();

  int master_ = -1;
  pid_t pid_ = -1;
  std::string shown_;
  std::size_t waited_ = 0;  ///< Offset after the last text that was waited for.
};

}  // namespace rondure::app::testing
