#include "cmm/ipp_service.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "cmm/ipp_errors.h"
#include "wire/wire_log.h"

namespace rondure::cmm::ipp {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{100};  // between looks for a stop and for other clients
constexpr int kEmergencyStop = 500;

double now_s() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

/// How long to wait for a line: until the server has something to do.
milliseconds waits(const Server& server) {
  const auto next_s = server.next_event_s();
  if (!next_s) return kLook;
  const double left_ms = std::ceil((*next_s - now_s()) * 1e3);
  return milliseconds(static_cast<int>(std::clamp(left_ms, 0.0, double(kLook.count()))));
}

core::Result<void> send_all(wire::LineTransport& client, Server& server) {
  for (const std::string& line : server.take_output()) {
    if (auto sent = client.write_line(line); !sent) return sent;
  }
  return {};
}

/// Takes the next line, if one comes in time, and does what is due.
core::Result<void> serve_once(wire::LineTransport& client, Server& server) {
  auto line = client.read_line(waits(server));
  if (!line) return core::fail(line.error());
  if (*line) {
    const auto fault = (*line)->crlf ? RawLine::Fault::kNone : RawLine::Fault::kLineEnd;
    server.receive({std::move((*line)->text), fault}, now_s());
  }
  server.advance(now_s());
  return send_all(client, server);
}

void send_away(wire::LineTransport& other, const std::string& present) {
  const std::string why =
      fmt::format("this server has a client already, {}; it takes one at a time", present);
  [[maybe_unused]] const auto told =
      other.write_line(error_line(kUnsolicited, error_report(kBadContext, why)));
  other.close();
}

/// Until the client goes or a stop is requested; why it went.
std::string serve_client(wire::TcpListener& listener, wire::LineTransport& client, Server& server,
                         const ServiceOptions& options) {
  double looked_s = now_s();
  while (!options.stop_requested()) {
    if (auto served = serve_once(client, server); !served) return served.error().what;
    if (now_s() - looked_s < std::chrono::duration<double>(kLook).count()) continue;
    looked_s = now_s();
    auto other = listener.accept(milliseconds(0));
    if (!other || *other == nullptr) continue;
    options.tell(fmt::format("{} was sent away: {} is connected", (*other)->peer(), client.peer()));
    send_away(**other, client.peer());
  }
  [[maybe_unused]] const auto told = client.write_line(error_line(
      kUnsolicited, error_report(kEmergencyStop, "the server was ended by its operator")));
  return "the server ends";
}

}  // namespace

core::Result<void> serve(wire::TcpListener& listener, Server& server,
                         const ServiceOptions& options) {
  while (!options.stop_requested()) {
    auto accepted = listener.accept(kLook);
    if (!accepted) return core::fail(accepted.error());
    std::unique_ptr<wire::LineTransport> client = std::move(*accepted);
    if (client == nullptr) continue;
    if (!options.wire_log.empty()) {
      auto logged = wire::logged(std::move(client), options.wire_log, wire::Side::kServer);
      if (!logged) return core::fail(logged.error());
      client = std::move(*logged);
    }
    options.tell(fmt::format("{} is connected", client->peer()));
    const std::string why = serve_client(listener, *client, server, options);
    server.disconnect(now_s());
    options.tell(fmt::format("{} has gone: {}", client->peer(), why));
    client->close();
  }
  return {};
}

}  // namespace rondure::cmm::ipp
