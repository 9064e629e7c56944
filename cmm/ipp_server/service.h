#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string_view>

#include "cmm/ipp_server/server.h"
#include "core/result.h"
#include "wire/tcp_line.h"

namespace rondure::cmm::ipp {

/// How a server is run.
struct ServiceOptions {
  std::function<bool()> stop_requested;        ///< Asked at least ten times a second.
  std::function<void(std::string_view)> tell;  ///< One line for the person who watches.
  std::filesystem::path wire_log;              ///< Empty: none.
  /// After so long without a line from the client, while nothing moves, another one takes its
  /// place.
  std::chrono::milliseconds silence_limit{60'000};
};

/// Serves one client after the other until a stop is requested. A second client is told who is
/// there and sent away, unless the first one has been silent for too long: that one is sent away
/// then (a program that hangs or was halted keeps its connection for ever). When the client goes,
/// what moves is stopped and its session is over; the machine stays as it is for the next one.
/// @return  kMachine when the port cannot be listened to any longer, kFile of the wire log.
[[nodiscard]] core::Result<void> serve(wire::TcpListener& listener, Server& server,
                                       const ServiceOptions& options);

}  // namespace rondure::cmm::ipp
