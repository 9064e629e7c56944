#pragma once

#include <chrono>
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

}  // namespace rondure::wire
