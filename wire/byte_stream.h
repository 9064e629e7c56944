#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::wire {

/// A connection that carries bytes both ways: a serial device, a USB bridge, a TCP connection.
/// Nothing is said about packets: what was written together may come in pieces, and the reverse.
///
/// Errors are kMachine, with whom the connection is to and what happened; is_open() is false from
/// then on, and every further call fails with the same error. Not for use by two threads at once.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Sends all bytes; returns when the system has taken them. An error also when the other side
  /// takes none for the time limit that the stream was opened with.
  [[nodiscard]] virtual core::Result<void> write(std::string_view bytes) = 0;
  /// What has come, at least one byte, as soon as it is there; "" when nothing came within the time
  /// limit, which is not an error. A limit of zero only looks at what is there.
  [[nodiscard]] virtual core::Result<std::string> read_some(
      std::chrono::milliseconds time_limit) = 0;
  /// Closes the connection. Safe to call twice.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_open() const = 0;
  /// Who is at the other end, e.g. "/dev/ttyACM0" or "127.0.0.1:1294".
  [[nodiscard]] virtual std::string peer() const = 0;
};

}  // namespace rondure::wire
