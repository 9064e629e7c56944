#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rondure::wire {

/// A bare TCP client on this computer, for tests: sends any bytes, including incomplete lines.
class RawSocket {
 public:
  /// Connects to 127.0.0.1; check connected().
  explicit RawSocket(std::uint16_t port);
  ~RawSocket();
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }
  /// False when the other side has closed the connection.
  bool send(std::string_view bytes);
  /// Returns up to `most` bytes, at least one unless the other side has closed. Waits at most 5 s.
  std::string receive(std::size_t most);
  void close();

 private:
  int handle_ = -1;
  bool connected_ = false;
};

}  // namespace rondure::wire
