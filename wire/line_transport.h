#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::wire {

/// A line as it came in, without its line end.
struct Line {
  std::string text;
  bool crlf = true;  ///< Ended by CR LF; false: by LF alone. Any other CR stays in the text.
};

/// A connection that carries lines of text both ways. The bytes of a line are not judged here:
/// whoever knows the protocol says what a strange character means.
///
/// Errors are kMachine, with whom the connection is to and what happened; is_open() is false from
/// then on, and every further call fails with the same error. Not for use by two threads at once.
class LineTransport {
 public:
  virtual ~LineTransport() = default;
  LineTransport() = default;
  LineTransport(const LineTransport&) = delete;
  LineTransport& operator=(const LineTransport&) = delete;

  /// Sends the text and CR LF. Returns when the system has taken all of it.
  [[nodiscard]] virtual core::Result<void> write_line(std::string_view text) = 0;
  /// The next line, or nothing when none was complete within the time limit: what came of it is
  /// kept for the next call. A limit of zero only looks at what is there.
  /// Errors: the other side closed, also in the middle of a line; a line beyond the length limit.
  [[nodiscard]] virtual core::Result<std::optional<Line>> read_line(
      std::chrono::milliseconds time_limit) = 0;
  /// What came of a line whose end has not come, its first 100 bytes at most; also of a connection
  /// that was lost. "" otherwise.
  [[nodiscard]] virtual std::string unfinished() const { return {}; }
  /// Closes the connection. Safe to call twice.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_open() const = 0;
  /// Who is at the other end, e.g. "127.0.0.1:1294".
  [[nodiscard]] virtual std::string peer() const = 0;
};

}  // namespace rondure::wire
