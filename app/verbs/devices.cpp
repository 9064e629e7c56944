#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/devices.h"
#include "app/text/ippdme.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "cmm/ipp/grammar.h"
#include "cmm/ipp_client/survey.h"
#include "core/numbers.h"
#include "wire/tcp_line.h"

namespace rondure::app {
namespace {

/// HOST, HOST:PORT or [ADDRESS]:PORT; a bare address of IPv6 has more than one colon.
std::optional<ServerPlace> server_place(std::string_view text) {
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    port = text.substr(end + 1);
    text = text.substr(1, end - 1);
  } else if (const std::size_t colon = text.find(':'); colon == text.rfind(':')) {
    port = text.substr(std::min(colon, text.size()));
    text = text.substr(0, colon);
  }
  if (text.empty()) return std::nullopt;
  if (port.empty()) return ServerPlace{std::string(text), cmm::ipp::kDefaultPort};
  const auto number = core::parse_number(port.substr(1));
  const bool whole =
      number && *number >= 1.0 && *number <= 65535.0 && *number == std::floor(*number);
  if (port.front() != ':' || !whole) return std::nullopt;
  return ServerPlace{std::string(text), static_cast<std::uint16_t>(*number)};
}

}  // namespace

int devices(const DevicesArguments& arguments) {
  const auto plugged_in = wire::list_usb_devices();
  if (!plugged_in) {
    print_error(plugged_in.error().error());
    return kBadInput;
  }
  const auto found = found_devices(*plugged_in, wire::list_serial_ports());
  say(arguments.json ? devices_json(found) : devices_text(found));
  return kAllWell;
}

int server_device(const ServerDeviceArguments& arguments) {
  const auto place = server_place(arguments.place);
  if (!place) {
    print_error({core::Code::kMeaning,
                 fmt::format("{} is no HOST:PORT with a port from 1 to 65535, as 127.0.0.1:1294",
                             arguments.place),
                 {}});
    return kBadInput;
  }
  const std::chrono::milliseconds limit(std::llround(1000.0 * arguments.limit_s));
  wire::TcpOptions tcp;
  tcp.connect_limit = tcp.write_limit = limit;
  auto line = wire::connect_tcp(place->host, place->port, tcp);
  if (!line) {
    print_error(line.error());
    return kBadInput;
  }
  const auto found = cmm::ipp::client::survey(std::move(*line), limit);
  if (!found) {
    print_error(found.error());
    return kBadInput;
  }
  const nlohmann::ordered_json document = survey_json(*found, *place);
  return answer(document, arguments.json, [&] { return survey_text(document); });
}

}  // namespace rondure::app
