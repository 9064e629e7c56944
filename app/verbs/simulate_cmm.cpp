#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "cmm/ipp_server/profile.h"
#include "cmm/ipp_server/server.h"
#include "cmm/ipp_server/service.h"
#include "plans/cell/served_cell.h"
#include "plans/plan.h"
#include "wire/tcp_line.h"

namespace rondure::app {
namespace {

bool is_loopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1" || address == "localhost";
}

/// The information needed to start a client.
std::string greeting(const SimulateCmmArguments& arguments, plans::ServedCell& cell,
                     std::uint16_t port) {
  const std::string pace =
      std::isinf(arguments.speed)
          ? "without waiting"
          : fmt::format("{:.7g} times as fast as the machine", arguments.speed);
  const auto tools = cell.machine().capabilities().tools;
  return fmt::format(
      "{}: the virtual machine listens at {}:{} (I++ DME 1.4), {}\n"
      "A client sends StartSession(), Home(), ChangeTool(\"{}\"), then GoTo, PtMeas, "
      "ScanOnCircle,\n"
      "AlignPart in the machine frame; every line with a tag, ended by CR LF. Ctrl-C ends.\n",
      arguments.plan, arguments.address, port, pace, tools.empty() ? "NoTool" : tools.front());
}

cmm::ipp::ServerOptions options_of(const SimulateCmmArguments& arguments, const plans::Plan& plan) {
  cmm::ipp::ServerOptions out = plans::server_options(plan);
  out.speed = arguments.speed;
  for (const auto& profile : cmm::ipp::profiles()) {
    if (profile.name == arguments.profile) out.controller.profile = profile;
  }
  return out;
}

int serve(const SimulateCmmArguments& arguments, const plans::Plan& plan) {
  wire::TcpOptions limits;
  limits.max_line_bytes = 2 * cmm::ipp::kMaxLineLength;  // longer lines are not from an I++ client
  auto listener = wire::TcpListener::open(arguments.address, arguments.port, limits);
  if (!listener) return refuse(listener.error());
  plans::ServedCell cell(plan, arguments.seed.value_or(plan.simulation->seed));
  cmm::ipp::Server server(cell, options_of(arguments, plan));
  if (!is_loopback(arguments.address)) {
    tell(fmt::format("rondure: {} is open to other computers; I++ DME knows no password\n",
                     arguments.address));
  }
  say(greeting(arguments, cell, listener->port()));
  if (!output_reached()) return kBadInput;
  cmm::ipp::ServiceOptions service;
  service.stop_requested = stop_requested;
  service.tell = [](std::string_view line) { tell(fmt::format("rondure: {}\n", line)); };
  service.wire_log = arguments.wire_log;
  service.silence_limit =
      std::chrono::milliseconds(std::llround(1000.0 * arguments.silence_limit_s));
  if (auto served = cmm::ipp::serve(*listener, server, service); !served)
    return refuse(served.error());
  tell("rondure: ended\n");
  return kAllWell;
}

}  // namespace

int simulate_cmm(const SimulateCmmArguments& arguments) {
  const auto plan = plans::read_plan(arguments.plan);
  if (!plan) return refuse(plan.error());
  if (auto servable = plans::check_servable(*plan); !servable)
    return refuse(servable.error().at(arguments.plan));
  // Checked now instead of when the first client connects.
  if (!arguments.wire_log.empty() && !std::ofstream(arguments.wire_log, std::ios::app)) {
    print_error(
        {core::Code::kFile, "cannot be written; choose another --wire-log", arguments.wire_log});
    return kBadInput;
  }
  listen_for_stop();
  return serve(arguments, *plan);
}

}  // namespace rondure::app
