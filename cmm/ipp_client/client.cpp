#include "cmm/ipp_client/client.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cmm/grid.h"
#include "cmm/ipp_client/internal/failure.h"
#include "cmm/scan_path.h"
#include "cmm/touch_check.h"
#include "core/numbers.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;
using ipp::call_item;
using ipp::Item;

using ipp::client::error_of;
using ipp::client::Reply;

// Exceeds every window within which a move counts as finished.
constexpr double kAfterMove_mm = 1.0;
constexpr double kToReturn_mm = -1.0;  // PtMeasPar.Retract: back to the approach point

std::vector<Item> coordinates(const Vector3d& p) {
  return {call_item("X", {p.x()}), call_item("Y", {p.y()}), call_item("Z", {p.z()})};
}

}  // namespace

IppMachine::IppMachine(Connect connect, IppMachineOptions options)
    : connect_(std::move(connect)), options_(std::move(options)) {}

core::Result<std::unique_ptr<IppMachine>> IppMachine::open(Connect connect,
                                                           const IppMachineOptions& options) {
  std::unique_ptr<IppMachine> out(new IppMachine(std::move(connect), options));
  // For any error of the machine, no command of the plan has been sent yet.
  if (auto connected = out->connect(); !connected) {
    return core::machine_fault(connected.error().what);
  }
  return out;
}

core::Result<void> IppMachine::connect() {
  TRY(auto line, connect_());
  dialogue_ = std::make_unique<ipp::client::Dialogue>(
      std::move(line),
      ipp::client::SessionOptions{options_.answer_limit, options_.abort_works, options_.numbers},
      options_.answer_limit);
  dialogue_->session().ask_for_stop([this] { return is_stop_wanted(); });
  TRY(identity_, dialogue_->start());
  TRY(const auto tool, dialogue_->active_tool());
  tool_ = tool;
  if (auto named = check_named(options_.tool); !named) return named;  // before any motion
  if (auto read = read_tool_radius(); !read) return read;
  TRY(homed_, dialogue_->is_homed());
  next_touch_ = -1;
  last_touch_.reset();
  effective_radius_mm_.reset();
  point_known_ = false;
  TRY(const auto stands, dialogue_->position_W_mm());
  position_W_mm_ = on_grid_mm(stands);
  temperature_degC_.reset();
  if (auto read = read_part_temperature(); !read) return read;
  return read_speed_limits();
}

core::Result<void> IppMachine::read_part_temperature() {
  if (!identity_.has_temperatures) return {};
  TRY(const auto temperature, dialogue_->property("Part.Temperature"));
  if (temperature) {
    if (auto sane = check_temperature("Part.Temperature", *temperature); !sane) return sane;
    temperature_degC_ = temperature;
  }
  return {};
}

std::string IppMachine::description() const {
  return fmt::format(
      "I++ DME {} machine {} at {}, tool {}, touch speed {:.7g} mm/s{}{}", identity_.version,
      identity_.machine_class.empty() ? "of unknown class" : identity_.machine_class,
      dialogue_->session().peer(), options_.tool.empty() ? tool_ : options_.tool,
      options_.speeds.touch_mm_s, knows_temperature() ? "" : ", gives no part temperature",
      options_.returns_to_approach
          ? ""
          : ", which point its PtMeas means cannot be checked (retract by distance)");
}

Capabilities IppMachine::capabilities() const {
  Capabilities out;
  out.name = identity_.machine_class.empty() ? "I++ DME machine" : identity_.machine_class;
  out.scans_circles = identity_.scans && tool_scans_;
  out.no_scans = identity_.scans ? "its tool has no Tool.ScanPar" : identity_.no_scans;
  out.least = least_;
  out.greatest = greatest_;
  out.tools = identity_.tools;
  return out;
}

bool IppMachine::has_rotary_table() const {
  return identity_.machine_class.find("RotaryTable") != std::string::npos;
}

double IppMachine::time_s() const {
  if (identity_.tells_time) return server_time_s_;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - opened_).count();
}

core::Result<MachineStatus> IppMachine::status() {
  MachineStatus out;
  out.stopped = stopped_;
  out.tool = tool_;
  out.fault = dialogue_->fault();
  out.homed = homed_;
  if (!dialogue_->session().usable()) out.fault = "the connection is lost";
  if (!out.fault.empty()) return out;  // a server in its error state answers no other request
  TRY(const auto homed, dialogue_->is_homed());
  out.homed = homed_ = homed;
  return out;
}

bool IppMachine::is_stop_wanted() {
  if (options_.stop_requested && options_.stop_requested()) stopped_ = true;
  return stopped_;
}

core::Error IppMachine::stopped_before(std::string_view what) const {
  return {core::Code::kStopped,
          fmt::format("the machine was stopped at {}{}; it moves again once the stop is taken back",
                      in_words(position_W_mm_),
                      what.empty() ? "" : fmt::format(", {} was not begun", what)),
          {}};
}

core::Result<void> IppMachine::check_ready() {
  if (is_stop_wanted()) return core::fail(stopped_before(""));
  if (!dialogue_->fault().empty()) {
    return core::machine_fault(
        "the machine is in its error state: {}; put that right at the machine, then resume",
        dialogue_->fault());
  }
  if (!homed_) return core::machine_fault("the machine is not homed; home it first, no motion");
  return {};
}

core::Result<Reply> IppMachine::run(std::string_view method, std::vector<Item> items,
                                    double length_mm, const std::string& doing) {
  if (is_stop_wanted()) return core::fail(stopped_before(doing));
  const double longest_s = 2.0 * length_mm / std::max(1e-3, options_.speeds.touch_mm_s);
  const auto limit = options_.motion_limit +
                     std::chrono::milliseconds(std::llround(1000.0 * std::min(longest_s, 1e6)));
  auto reply = dialogue_->move(method, std::move(items), limit);
  if (reply) return std::move(*reply);
  core::Error error = error_of(reply.error(), doing);
  if (dialogue_->session().usable() &&
      (dialogue_->fault().empty() || error.code == core::Code::kCollision)) {
    if (const auto stands = dialogue_->position_W_mm()) position_W_mm_ = on_grid_mm(*stands);
    if (error.code == core::Code::kStopped) {
      error.what += fmt::format(
          ", the tip stands at {}; see that its way up is free before the "
          "run is resumed",
          in_words(position_W_mm_));
    }
  }
  return core::fail(std::move(error));
}

core::Result<void> IppMachine::go_to(const Vector3d& tip_W_mm) {
  if (tip_W_mm == position_W_mm_) return {};
  TRY_DO(run("GoTo", coordinates(tip_W_mm), (tip_W_mm - position_W_mm_).norm(),
             fmt::format("the move to {}", in_words(tip_W_mm))));
  last_move_W_mm_ = {position_W_mm_, tip_W_mm};
  position_W_mm_ = tip_W_mm;
  return {};
}

core::Result<void> IppMachine::home() {
  homed_ = true;  // needed by the other checks of check_ready()
  if (auto ready = check_ready(); !ready) {
    homed_ = false;
    return ready;
  }
  const auto homed = dialogue_->is_homed();
  homed_ = homed && *homed;
  if (!homed) return core::fail(homed.error());
  if (!homed_) {
    TRY_DO(run("Home", {}, 0.0, "homing"));
    homed_ = true;
  }
  TRY(const auto stands, dialogue_->position_W_mm());
  position_W_mm_ = on_grid_mm(stands);
  Vector3d above = position_W_mm_;
  above.z() = std::max(above.z(), options_.park_W_mm.z());
  if (!options_.tool.empty() && options_.tool != tool_) {
    if (auto up = go_to(above); !up) return up;
    if (auto taken = take_tool(options_.tool); !taken) return taken;
    above = {position_W_mm_.x(), position_W_mm_.y(), std::max(above.z(), position_W_mm_.z())};
  }
  if (auto fits = check_tool(); !fits) return fits;
  if (auto sent = send_speeds(); !sent) return sent;
  if (auto up = go_to(above); !up) return up;
  const Vector3d park = on_grid_mm(options_.park_W_mm);
  if (auto parked = go_to(park); !parked) return parked;
  TRY(const auto parks, dialogue_->position_W_mm());
  if (auto there = check_stands("the move", park, parks, kAfterMove_mm); !there) {
    return core::fail(distrust(there.error()));
  }
  return {};
}

core::Error IppMachine::distrust(const core::Error& error) {
  dialogue_->hold(error.what);
  return error;
}

core::Result<void> IppMachine::move_to(const Vector3d& tip_W_mm) {
  if (auto ready = check_ready(); !ready) return ready;
  if (!tip_W_mm.allFinite())
    return core::machine_fault("the target of a move is not a finite point; no motion");
  return go_to(on_grid_mm(tip_W_mm));
}

core::Result<void> IppMachine::set_touch_distances(const TouchCommand& command) {
  const double retract_mm = options_.returns_to_approach ? kToReturn_mm : command.approach_mm;
  const std::array<std::pair<std::string_view, double>, 3> values = {{
      {"Tool.PtMeasPar.Approach", command.approach_mm},
      {"Tool.PtMeasPar.Search", command.search_mm},
      {"Tool.PtMeasPar.Retract", retract_mm},
  }};
  return dialogue_->set(values);
}

core::Result<TouchReading> IppMachine::touch(const TouchCommand& given) {
  TRY_DO(check_ready());
  TRY_DO(check_touch(given, position_W_mm_));
  const TouchCommand command = on_grid(given);
  const TouchCommand sent = point_known_ ? command : for_either_reading(command);
  const bool slow = is_cautious() && sent.approach_mm == command.approach_mm;
  TRY_DO(slow_down(slow));
  TRY_DO(set_touch_distances(sent));
  TRY_DO(number_touch(command.id));
  const Vector3d start = position_W_mm_;
  std::vector<Item> items =
      coordinates(named_point(command.expected_tip_W_mm, command.direction_W));
  items.push_back(call_item("IJK", Vector3d(-command.direction_W)));
  const auto reply = run("PtMeas", std::move(items), command.approach_mm + command.search_mm,
                         fmt::format("the touch at {}", in_words(command.expected_tip_W_mm)));
  if (!reply) {
    // The return path is free along the line that was just searched.
    const bool goes_back = reply.error().code == core::Code::kNoTouch;
    if (goes_back) {
      TRY_DO(go_to(start));
      TRY_DO(slow_down(false));
    }
    return core::fail(with_point_advice(reply.error()));
  }
  next_touch_ = command.id < 0 ? -1 : command.id + 1;
  TRY_DO(slow_down(false));
  TRY(const auto reading, reading_of(*reply, command));
  if (!options_.returns_to_approach) {
    position_W_mm_ = reading.tip_W_mm - command.approach_mm * command.direction_W;
    TRY_DO(go_to(start));
  } else if (!point_known_) {
    TRY_DO(check_point(command, sent));
  }
  return reading;
}

core::Result<void> IppMachine::check_point_of(const ipp::client::PointReport& point,
                                              const TouchCommand& command) const {
  auto sane = check_contact(command, point.tip_W_mm);
  if (sane && last_touch_) {
    sane = check_fresh(command, point.tip_W_mm, last_touch_->first, last_touch_->second);
  }
  if (sane && point.normal_W) sane = check_normal(*point.normal_W);
  const double known_mm = effective_radius_mm_.value_or(options_.tip_radius_mm);
  if (sane && point.tip_radius_mm && known_mm > 0.0) {
    sane = check_tip_radius(*point.tip_radius_mm, known_mm, options_.tip_tolerance_mm);
  }
  return sane;
}

core::Result<TouchReading> IppMachine::reading_of(const Reply& reply, const TouchCommand& command) {
  TRY(const auto point, dialogue_->point_of(reply));
  if (auto sane = check_point_of(point, command); !sane) return core::fail(distrust(sane.error()));
  for (const auto& [name, degC] : {std::pair("Part.Temperature", point.temperature_degC),
                                   std::pair("Scale.Temperature", point.scale_temperature_degC)}) {
    if (!degC) continue;
    TRY_DO(check_temperature(name, *degC));
  }
  last_touch_ = {command, point.tip_W_mm};
  if (!effective_radius_mm_) effective_radius_mm_ = point.tip_radius_mm;
  if (point.temperature_degC) temperature_degC_ = point.temperature_degC;
  if (point.time_s) server_time_s_ = *point.time_s;
  TouchReading out;
  out.tip_W_mm = point.tip_W_mm;
  out.temperature_degC = temperature_degC_;
  if (point.scale_temperature_degC) scale_temperature_degC_ = point.scale_temperature_degC;
  out.scale_temperature_degC = scale_temperature_degC_;
  out.time_s = time_s();
  out.tip_radius_mm = point.tip_radius_mm.value_or(0.0);
  return on_grid(out);
}

core::Result<void> IppMachine::tell_simulation(std::string_view name, std::int64_t value) {
  if (!identity_.simulated) return {};
  const auto set = dialogue_->ask("SetProp", {call_item(name, {static_cast<double>(value)})});
  if (!set) return core::fail(error_of(set.error(), "telling the simulator where the run stands"));
  return {};
}

core::Result<Vector3d> IppMachine::tip_in_part_system_mm() {
  const auto chosen = dialogue_->choose_system("PartCsy");
  auto tip = chosen ? dialogue_->position_W_mm() : core::fail(chosen.error());
  if (auto back = dialogue_->choose_system("MachineCsy"); !back) {
    return core::fail(distrust(back.error()));
  }
  return tip;
}

core::Result<void> IppMachine::number_touch(std::int64_t id) {
  if (!identity_.simulated || id < 0 || id == next_touch_) return {};
  next_touch_ = id;
  return tell_simulation("Simulation.NextTouch", id);
}

core::Result<void> IppMachine::recover() {
  stopped_ = false;
  if (!dialogue_->session().usable()) return connect();
  if (auto cleared = dialogue_->clear(); !cleared) return cleared;
  TRY(const auto tool, dialogue_->active_tool());
  if (tool != tool_) {
    dialogue_->forget_properties();
    effective_radius_mm_.reset();
  }
  tool_ = tool;
  if (auto read = read_tool_radius(); !read) return read;
  TRY(const auto stands, dialogue_->position_W_mm());
  position_W_mm_ = on_grid_mm(stands);
  return {};
}

}  // namespace rondure::cmm
