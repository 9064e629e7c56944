#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::wire {

/// A connection that carries bytes both ways: a serial device, a USB bridge, a TCP connection.
/// Packet boundaries are not kept: bytes written together may arrive in pieces, and the reverse.
///
/// Errors are kMachine and name the peer and the cause. After an error is_open() is false, and
/// every further call fails with the same error. Not for use by two threads at once.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Sends all bytes and returns when the system has accepted them. It is also an error when the
  /// other side accepts nothing within the write limit given when the stream was opened.
  [[nodiscard]] virtual core::Result<void> write(std::string_view bytes) = 0;
  /// Returns the received bytes, at least one, as soon as they arrive; "" when nothing arrived
  /// within the time limit, which is not an error. With a limit of zero the call does not wait.
  [[nodiscard]] virtual core::Result<std::string> read_some(
      std::chrono::milliseconds time_limit) = 0;
  /// Closes the connection. Safe to call twice.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_open() const = 0;
  /// The other end, e.g. "/dev/ttyACM0" or "127.0.0.1:1294".
  [[nodiscard]] virtual std::string peer() const = 0;
};

/// A line as received, without its line end.
struct Line {
  std::string text;
  bool crlf = true;  ///< Ended by CR LF; false: by LF alone. Any other CR stays in the text.
};

/// A connection that carries lines of text both ways. The bytes of a line are not checked here; the
/// protocol layer decides about unexpected characters.
///
/// Errors are kMachine and name the peer and the cause. After an error is_open() is false, and
/// every further call fails with the same error. Not for use by two threads at once.
class LineTransport {
 public:
  virtual ~LineTransport() = default;
  LineTransport() = default;
  LineTransport(const LineTransport&) = delete;
  LineTransport& operator=(const LineTransport&) = delete;

  /// Sends the text and CR LF. Returns when the system has taken all of it.
  [[nodiscard]] virtual core::Result<void> write_line(std::string_view text) = 0;
  /// The next line, or nothing when no line was complete within the time limit; an incomplete line
  /// is kept for the next call. With a limit of zero the call does not wait.
  /// Errors: the other side closed the connection, also in the middle of a line; a line exceeds the
  /// length limit.
  [[nodiscard]] virtual core::Result<std::optional<Line>> read_line(
      std::chrono::milliseconds time_limit) = 0;
  /// At most the first 100 bytes of a line whose end has not arrived, even after the connection was
  /// lost; "" when there is none.
  [[nodiscard]] virtual std::string unfinished() const { return {}; }
  /// Closes the connection. Safe to call twice.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_open() const = 0;
  /// The other end, e.g. "127.0.0.1:1294".
  [[nodiscard]] virtual std::string peer() const = 0;
};

}  // namespace rondure::wire
