#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/result.h"
#include "wire/transport.h"

namespace rondure::wire {

/// Limits of a TCP connection.
struct TcpOptions {
  std::chrono::milliseconds connect_limit{5000};  ///< Time to establish the connection.
  std::chrono::milliseconds write_limit{5000};    ///< Time for the peer to accept the bytes sent.
  std::size_t max_line_bytes = std::size_t{1} << 20;  ///< A longer line ends the connection.
};

/// Connects to a server.
/// @param host  Name or address.
/// @return  kMachine when the name is unknown, nobody listens there, or the time limit passed.
[[nodiscard]] core::Result<std::unique_ptr<LineTransport>> connect_tcp(
    const std::string& host, std::uint16_t port, const TcpOptions& options = {});

/// A TCP port that accepts clients; each call of accept() returns one.
class TcpListener {
 public:
  /// Listens on an address of this computer.
  /// @param address  "127.0.0.1": programs of this computer only; "0.0.0.0": the whole network.
  /// @param port  0: any free one, see port().
  /// @return  kMachine when the address is not one of this computer, or the port is in use.
  [[nodiscard]] static core::Result<TcpListener> open(const std::string& address,
                                                      std::uint16_t port,
                                                      const TcpOptions& options = {});
  TcpListener(TcpListener&&) noexcept;
  TcpListener& operator=(TcpListener&&) noexcept;
  ~TcpListener();

  [[nodiscard]] std::uint16_t port() const;
  /// The next client, or nullptr when none connected within the time limit.
  [[nodiscard]] core::Result<std::unique_ptr<LineTransport>> accept(
      std::chrono::milliseconds time_limit);

 private:
  struct Socket;
  explicit TcpListener(std::unique_ptr<Socket> socket);
  std::unique_ptr<Socket> socket_;
};

}  // namespace rondure::wire
