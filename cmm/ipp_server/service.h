#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string_view>

#include "cmm/ipp_server/server.h"
#include "core/result.h"
#include "wire/tcp_line.h"

namespace rondure::cmm::ipp {

/// Settings of a running service.
struct ServiceOptions {
  std::function<bool()> stop_requested;        ///< Polled at least ten times a second.
  std::function<void(std::string_view)> tell;  ///< Receives one line for the user.
  std::filesystem::path wire_log;              ///< Log of all lines; empty: none.
  /// A client that sent no line for this long, while nothing moves, may be replaced by another one.
  std::chrono::milliseconds silence_limit{60'000};
};

/// Serves one client after the other until a stop is requested. A second client receives a message
/// that names the connected client, and is disconnected, unless the first one exceeds the silence
/// limit: then the first one is disconnected (a hung or halted program would otherwise keep its
/// connection for ever). When a client leaves, motions are stopped and its session ends; the
/// machine keeps its state for the next one.
/// @return  kMachine when listening on the port fails, kFile for the wire log.
[[nodiscard]] core::Result<void> serve(wire::TcpListener& listener, Server& server,
                                       const ServiceOptions& options);

}  // namespace rondure::cmm::ipp
