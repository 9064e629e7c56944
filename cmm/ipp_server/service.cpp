#include "cmm/ipp_server/service.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "wire/wire_log.h"

namespace rondure::cmm::ipp {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{100};  // between polls for a stop and for other clients
constexpr int kEmergencyStop = 500;

double now_s() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

/// Time to wait for a line: until the server's next event.
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

/// Takes the next line, if one arrives in time, and advances the server.
/// @return  Whether the client sent a line.
core::Result<bool> serve_once(wire::LineTransport& client, Server& server) {
  TRY(auto line, client.read_line(waits(server)));
  const bool said = line.has_value();
  if (said) {
    server.receive({std::move(line->text), line->crlf}, now_s());
  }
  server.advance(now_s());
  TRY_DO(send_all(client, server));
  return said;
}

void send_away(wire::LineTransport& client, const std::string& why) {
  [[maybe_unused]] const auto sent =
      client.write_line(error_line(kUnsolicited, error_report(kBadContext, why)));
  client.close();
}

/// Reason why the service of a client ended.
struct Departure {
  std::string why;
  std::unique_ptr<wire::LineTransport> next;  ///< The client that takes its place; null: none yet.
};

/// Serves until the client leaves, loses its place or a stop is requested.
Departure serve_client(wire::TcpListener& listener, wire::LineTransport& client, Server& server,
                       const ServiceOptions& options) {
  const double limit_s = std::chrono::duration<double>(options.silence_limit).count();
  double looked_s = now_s();
  double active_s = looked_s;  // time of the client's last line or motion
  while (!options.stop_requested()) {
    const auto said = serve_once(client, server);
    if (!said) return {said.error().what, nullptr};
    if (*said || server.next_event_s()) active_s = now_s();
    if (now_s() - looked_s < std::chrono::duration<double>(kLook).count()) continue;
    looked_s = now_s();
    auto other = listener.accept(milliseconds(0));
    if (!other || *other == nullptr) continue;
    // The first client may just have closed its connection because its program ended; the other is
    // next.
    const auto there = serve_once(client, server);
    if (!there) return {there.error().what, std::move(*other)};
    if (*there) active_s = now_s();
    const double silent_s = now_s() - active_s;
    if (silent_s >= limit_s) {
      send_away(client,
                fmt::format("silent for {:.0f} s; another client takes its place", silent_s));
      return {fmt::format("it was silent for {:.0f} s and {} came", silent_s, (*other)->peer()),
              std::move(*other)};
    }
    options.tell(fmt::format("{} was sent away: {} is connected", (*other)->peer(), client.peer()));
    send_away(**other, fmt::format("this server has a client already, {}, silent for {:.0f} s; it "
                                   "takes one at a time, another one after {:g} s of silence",
                                   client.peer(), silent_s, limit_s));
  }
  [[maybe_unused]] const auto sent = client.write_line(error_line(
      kUnsolicited, error_report(kEmergencyStop, "the server was ended by its operator")));
  return {"the server ends", nullptr};
}

}  // namespace

core::Result<void> serve(wire::TcpListener& listener, Server& server,
                         const ServiceOptions& options) {
  std::unique_ptr<wire::LineTransport> client;
  while (!options.stop_requested()) {
    if (client == nullptr) {
      TRY(client, listener.accept(kLook));
    }
    if (client == nullptr) continue;
    if (!options.wire_log.empty()) {
      TRY(client, wire::logged(std::move(client), options.wire_log, wire::Side::kServer));
    }
    options.tell(fmt::format("{} is connected", client->peer()));
    Departure departure = serve_client(listener, *client, server, options);
    server.disconnect(now_s());
    options.tell(fmt::format("{} has gone: {}", client->peer(), departure.why));
    client->close();
    client = std::move(departure.next);
  }
  return {};
}

}  // namespace rondure::cmm::ipp
