#include "tests/cmm/seen_server.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cmm/grid.h"
#include "cmm/ipp/internal/errors.h"
#include "core/units.h"

namespace rondure::cmm::ipp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kNumbersInALine = 90;
constexpr int kFine = 32;  // points scanned for one that is told, where steps are irregular

std::string decimals(double value) { return fmt::format("{:.5f}", value); }

std::string vector_text(const Vector3d& v) {
  return fmt::format("({},{},{})", decimals(v.x()), decimals(v.y()), decimals(v.z()));
}

/// An item as this server writes it: numbers with five decimals.
std::string seen_text(const Item& item) {
  if (item.kind == Item::Kind::kNumber) return decimals(item.number);
  if (item.kind != Item::Kind::kCall) return to_text(item);
  std::string out;
  for (const Item& inner : item.arguments) out += (out.empty() ? "" : ", ") + seen_text(inner);
  return fmt::format("{}({})", item.text, out);
}

std::string seen_text(const Command& command) {
  return to_text(command.tag) + " " + seen_text(call_item(command.method, command.arguments));
}

std::vector<double> numbers_in(const Command& command) {
  std::vector<double> out;
  for (const Item& item : command.arguments) {
    if (item.kind == Item::Kind::kNumber) out.push_back(item.number);
  }
  return out;
}

Vector3d three(const std::vector<double>& n, std::size_t first) {
  return {n[first], n[first + 1], n[first + 2]};
}

/// Names of X(), Y(), sorted; nothing when one of them is not among the known ones.
std::optional<std::vector<std::string>> names_in(const Command& command,
                                                 const std::vector<std::string>& known) {
  std::vector<std::string> out;
  for (const Item& item : command.arguments) {
    if (std::find(known.begin(), known.end(), item.text) == known.end()) return std::nullopt;
    out.push_back(item.text);
  }
  std::sort(out.begin(), out.end());
  if (out.empty()) return std::nullopt;
  return out;
}

int number_of(const core::Error& error, std::string_view method) {
  switch (error.code) {
    case core::Code::kNoTouch:
      return kSurfaceNotFound;
    case core::Code::kCollision:
      return kCollision;
    case core::Code::kUnreachable:
      return method == "GoTo" ? kMoveOutOfLimits : kOutOfVolume;
    case core::Code::kPoseRange:
      return kAngleOutOfRange;
    default:
      return kProcessing;
  }
}

}  // namespace

SeenServer::SeenServer(Backend& backend, const SeenProfile& profile)
    : backend_(backend),
      profile_(profile),
      parameters_(profile.defaults, backend.machine().capabilities().least,
                  backend.machine().capabilities().greatest) {}

std::vector<std::string> SeenServer::take_output() { return std::exchange(output_, {}); }

void SeenServer::disconnect() {
  pending_.clear();
  move_.reset();
  daemons_.clear();
  output_.clear();
  session_ = error_ = false;
}

void SeenServer::tell_error(const Tag& tag, int number, const std::string& text) {
  const ErrorReport report = error_report(number, text);
  output_.push_back(error_line(tag, report));
  if (report.severity >= kErrorState) error_ = true;
}

void SeenServer::receive(const RawLine& line, double now_s) {
  const auto command = parse_command(line);
  if (!command) {
    const Refusal& refusal = command.error();
    const Tag tag = refusal.tag.value_or(kUnsolicited);
    if (refusal.tag) output_.push_back(ack_line(tag));
    tell_error(tag, error_ && refusal.tag ? kUseClearAllErrors : refusal.number, line.text);
    if (refusal.tag) output_.push_back(complete_line(tag));
    return;
  }
  output_.push_back(ack_line(command->tag));
  if (command->tag.event) return close(*command, execute(*command, now_s));
  pending_.push_back(*command);
  work(now_s);
}

void SeenServer::advance(double now_s) {
  for (Daemon& daemon : daemons_) {
    const Vector3d tip_W_mm = tip_now_W_mm(now_s);
    const double moved_mm = (tip_W_mm - daemon.last_W_mm).norm();
    const double since_s = now_s - daemon.last_s;
    if (moved_mm == 0.0 || since_s < 0.1) continue;
    if (since_s < daemon.interval_s && moved_mm < daemon.distance_mm) continue;
    output_.push_back(to_text(daemon.tag) + " # " + place(daemon.names, tip_W_mm));
    daemon.last_s = now_s;
    daemon.last_W_mm = tip_W_mm;
  }
  work(now_s);
}

void SeenServer::work(double now_s) {
  while (true) {
    if (move_) {
      if (now_s < move_->end_s) return;
      const Move move = *std::exchange(move_, std::nullopt);
      const auto moved = backend_.machine().move_to(move.to_W_mm);
      close(move.command, {{}, moved ? 0 : number_of(moved.error(), "GoTo")});
    }
    if (pending_.empty()) return;
    const Command command = std::move(pending_.front());
    pending_.pop_front();
    const Answer answer = execute(command, now_s);
    if (!move_) close(command, answer);
  }
}

void SeenServer::close(const Command& command, const Answer& answer) {
  for (const std::string& data : answer.data) {
    output_.push_back(to_text(command.tag) + " # " + data);
  }
  if (answer.error != 0) tell_error(command.tag, answer.error, seen_text(command));
  output_.push_back(complete_line(command.tag));
}

SeenServer::Answer SeenServer::execute(const Command& command, double now_s) {
  const std::string& method = command.method;
  if (!session_ && method != "StartSession" && method != "EndSession") return {{}, kProtocolError};
  const bool takes_back = method == "ClearAllErrors" || method == "GetErrStatusE" ||
                          method == "GetXtdErrStatus" || method == "AbortE" ||
                          (method == "StartSession" && !session_);
  if (error_ && !takes_back) return {{}, kUseClearAllErrors};
  const bool moves = method == "Home" || method == "GoTo" || method == "PtMeas" ||
                     (method == "ScanOnCircle" && profile_.scans) || method == "AlignPart";
  return moves ? motions(command, now_s) : in_session(command, now_s);
}

SeenServer::Answer SeenServer::in_session(const Command& command, double now_s) {
  const std::string& method = command.method;
  if (method == "StartSession") {
    if (session_) return {{}, kIllegalCommand};
    session_ = true;
    error_ = false;
    touch_report_ = {"X", "Y", "Z"};
    scan_report_ = {"Q", "X", "Y", "Z"};
    return {{}, backend_.machine().recover() ? 0 : kMachineInErrorState};
  }
  if (method == "EndSession") {
    session_ = false;
    daemons_.clear();
    return {};
  }
  if (method == "GetDMEVersion" && profile_.tells_version) return {{"DMEVersion(\"1.4\")"}, 0};
  if (method == "GetMachineClass") {
    const bool turns = !backend_.table_angles_deg().empty();
    return {{fmt::format("GetMachineClass(\"CartCMM{}\")", turns ? "WithRotaryTable" : "")}, 0};
  }
  if (method == "IsHomed") {
    const auto status = backend_.machine().status();
    return {{fmt::format("IsHomed({})", status && status->homed ? 1 : 0)}, 0};
  }
  return errors_and_daemons(command, now_s);
}

SeenServer::Answer SeenServer::errors_and_daemons(const Command& command, double now_s) {
  const std::string& method = command.method;
  if (method == "GetErrStatusE") return {{fmt::format("ErrStatus({})", error_ ? 1 : 0)}, 0};
  if (method == "GetXtdErrStatus") return {{"\"see the display of the controller\""}, 0};
  if (method == "ClearAllErrors") {
    if (!backend_.machine().recover()) return {{}, kMachineInErrorState};
    error_ = false;
    return {};
  }
  if (method == "GetErrorInfo") {
    const auto numbers = numbers_in(command);
    const ErrorEntry* entry =
        numbers.size() == 1 ? find_error(static_cast<int>(numbers.front())) : nullptr;
    if (entry == nullptr) return {{}, kIncorrectArguments};
    return {{fmt::format("\"{}\"", entry->text)}, 0};
  }
  if (method == "AbortE") return abort(now_s);
  if (method == "StopDaemon") {
    const auto found = std::find_if(daemons_.begin(), daemons_.end(), [&](const Daemon& daemon) {
      return command.arguments.size() == 1 && command.arguments[0].text == to_text(daemon.tag);
    });
    if (found == daemons_.end()) return {{}, kNoSuchDaemon};
    daemons_.erase(found);
    return {};
  }
  if (method == "OnMoveReportE") {
    Daemon daemon;
    daemon.tag = command.tag;
    for (const Item& item : command.arguments) {
      const auto value = single_number(item);
      if (item.text == "Time" && value) {
        daemon.interval_s = *value;
      } else if (item.text == "Dis" && value) {
        daemon.distance_mm = *value;
      } else {
        daemon.names.push_back(item.text);
      }
    }
    daemon.last_s = now_s;
    daemon.last_W_mm = tip_now_W_mm(now_s);
    daemons_.push_back(daemon);
    return {};
  }
  return tools_and_properties(command);
}

SeenServer::Answer SeenServer::abort(double now_s) {
  if (move_) {
    const Vector3d tip_W_mm = tip_now_W_mm(now_s);
    const Move move = *std::exchange(move_, std::nullopt);
    (void)backend_.machine().move_to(tip_W_mm);
    close(move.command, {{}, kAborted});
  }
  pending_.clear();
  daemons_.clear();
  error_ = true;
  return {};
}

SeenServer::Answer SeenServer::tools_and_properties(const Command& command) {
  const std::string& method = command.method;
  const auto tools = backend_.machine().capabilities().tools;
  if (method == "EnumTools") {
    Answer out{{"\"NoTool\""}, 0};
    for (const std::string& tool : tools) out.data.push_back(fmt::format("\"{}\"", tool));
    return out;
  }
  if (method == "ChangeTool") {
    const auto name =
        command.arguments.size() == 1 ? string_of(command.arguments[0]) : std::nullopt;
    if (!name) return {{}, kIncorrectArguments};
    if (std::find(tools.begin(), tools.end(), *name) == tools.end()) return {{}, kToolNotFound};
    if (!backend_.machine().select_tool(*name)) return {{}, kProcessing};
    tool_ = *name;
    parameters_.reset();
    return {{}, backend_.machine().set_speeds(parameters_.speeds()) ? 0 : kProcessing};
  }
  const bool sets = method == "SetProp";
  if (!sets && method != "GetProp") return frames(command);
  std::string told;
  int error = 0;
  for (const Item& item : command.arguments) {
    const bool of_scan = item.text.starts_with("Tool.ScanPar.");
    if (!item.text.starts_with("Tool.") || (of_scan && !profile_.has_scan_parameters)) {
      return {{}, kIncorrectArguments};
    }
    const std::string name = item.text.substr(std::string_view("Tool.").size());
    std::string value;
    if (sets) {
      const auto wanted = single_number(item);
      if (!wanted) return {{}, kIncorrectArguments};
      const bool below = name == "PtMeasPar.Retract" && *wanted < 0.0;
      const bool clamps = below && !profile_.takes_negative_retract;
      const auto set = parameters_.set(name, clamps ? 0.0 : *wanted);
      if (set == ToolParameters::Set::kNoSuch) return {{}, kIncorrectArguments};
      if (clamps || set == ToolParameters::Set::kClamped) error = kOutOfRange;
      continue;
    }
    if (name == "Name") {
      value = fmt::format("\"{}\"", tool_.empty() ? "NoTool" : tool_);
    } else if (name == "AvrRadius") {
      value = decimals(tool_.empty() ? 0.0 : profile_.tip_radius_mm);
    } else if (const auto number = parameters_.get(name)) {
      value = decimals(*number);
    } else {
      return {{}, kIncorrectArguments};
    }
    told += fmt::format("{}{}({})", told.empty() ? "" : ", ", item.text, value);
  }
  if (!sets) return {{told}, 0};
  if (!backend_.machine().set_speeds(parameters_.speeds())) error = kProcessing;
  return {{}, error};
}

SeenServer::Answer SeenServer::frames(const Command& command) {
  const std::string& method = command.method;
  const auto& arguments = command.arguments;
  const std::string frame = arguments.empty() ? "" : arguments[0].text;
  if (method == "SetCoordSystem") {
    if (frame != "MachineCsy" && frame != "PartCsy") return {{}, kIncorrectArguments};
    in_part_csy_ = frame == "PartCsy";
    return {};
  }
  const auto n = numbers_in(command);
  if (method == "SetCsyTransformation") {
    if (frame != "PartCsy" || n.size() != 6) return {{}, kIncorrectArguments};
    part_csy_ = {three(n, 0), n[3], n[4], n[5]};
    return {};
  }
  if (method == "GetCsyTransformation") {
    const auto& t = part_csy_;
    return {{fmt::format("GetCsyTransformation({:.5f}, {:.5f}, {:.5f}, {:.5f}, {:.5f}, {:.5f})",
                         t.x0_mm.x(), t.x0_mm.y(), t.x0_mm.z(), t.theta_deg, t.psi_deg, t.phi_deg)},
            0};
  }
  return reports(command);
}

SeenServer::Answer SeenServer::reports(const Command& command) {
  const std::string& method = command.method;
  if (method == "Get") {
    const auto names = names_in(command, {"X", "Y", "Z", "R"});
    const bool turns = !backend_.table_angles_deg().empty();
    if (!names || (!turns && names->front() == "R")) return {{}, kIncorrectArguments};
    return {{place(*names, backend_.machine().position_W_mm())}, 0};
  }
  if (method == "OnPtMeasReport") {
    const auto names = names_in(command, {"X", "Y", "Z", "IJK", "ER", "Q"});
    if (!names) return {{}, kIncorrectArguments};
    touch_report_ = *names;
    return {};
  }
  if (method == "OnScanReport" && profile_.scans) {
    const auto names = names_in(command, {"X", "Y", "Z", "Q"});
    if (!names) return {{}, kIncorrectArguments};
    scan_report_ = *names;
    return {};
  }
  return {{}, kIllegalCommand};
}

std::optional<Vector3d> SeenServer::target(const Command& command) const {
  Vector3d out = to_csy(backend_.machine().position_W_mm());
  for (const Item& item : command.arguments) {
    if (item.text == "IJK" && command.method == "PtMeas") continue;
    const auto value = single_number(item);
    if (!value || item.text.size() != 1 || item.text < "X" || item.text > "Z") return std::nullopt;
    out[item.text[0] - 'X'] = *value;
  }
  return from_csy(out);
}

SeenServer::Answer SeenServer::motions(const Command& command, double now_s) {
  Machine& machine = backend_.machine();
  if (command.method == "Home") {
    if (!machine.home()) return {{}, kAtHome};
    return {{}, backend_.home_table() ? 0 : kAtHome};
  }
  const auto status = machine.status();
  if (!status || !status->homed) return {{}, kUnableToMove};
  if (command.method == "AlignPart") return align(command);
  if (command.method == "ScanOnCircle") return scan(command);
  if (command.method == "PtMeas") return touch(command);
  const auto to_W_mm = target(command);
  if (!to_W_mm) return {{}, kIncorrectArguments};  // R as well
  const Vector3d from_W_mm = machine.position_W_mm();
  const double takes_s =
      (*to_W_mm - from_W_mm).norm() / parameters_.speeds().travel_mm_s / profile_.speed;
  move_ = Move{command, from_W_mm, *to_W_mm, now_s, now_s + takes_s};
  return {};
}

SeenServer::Answer SeenServer::touch(const Command& command) {
  const auto surface_W_mm = target(command);
  const Item* ijk = find_call(command.arguments, "IJK");
  const auto direction = ijk == nullptr ? std::nullopt : vector_of(*ijk);
  if (tool_.empty()) return {{}, kToolNotDefined};
  if (!surface_W_mm || !direction || direction->norm() < 1e-9) return {{}, kIncorrectArguments};
  const Vector3d outward_W = direction_on_grid(direction->normalized());
  TouchCommand touch;
  touch.id = touches_++;
  touch.direction_W = -outward_W;
  touch.expected_tip_W_mm = *surface_W_mm + profile_.tip_radius_mm * outward_W;
  touch.approach_mm = parameters_.act("PtMeasPar.Approach");
  touch.search_mm = parameters_.act("PtMeasPar.Search");
  touch = on_grid(touch);
  Machine& machine = backend_.machine();
  const Vector3d start =
      on_grid_mm(touch.expected_tip_W_mm - touch.approach_mm * touch.direction_W);
  if (const auto there = machine.move_to(start); !there) {
    return {{}, number_of(there.error(), command.method)};
  }
  const auto reading = machine.touch(touch);
  if (!reading) return {{}, number_of(reading.error(), command.method)};
  const double retract_mm = parameters_.act("PtMeasPar.Retract");
  if (retract_mm >= 0.0) {
    const auto back = machine.move_to(on_grid_mm(reading->tip_W_mm + retract_mm * outward_W));
    if (!back) return {{}, number_of(back.error(), command.method)};
  }
  const Vector3d p_mm = to_csy(reading->tip_W_mm);
  std::string told;
  for (const std::string& name : touch_report_) {
    const std::string value = name == "IJK"  ? "0.00000,0.00000,1.00000"  // what the tool thinks
                              : name == "ER" ? decimals(profile_.tip_radius_mm)
                              : name == "Q"  ? decimals(0.0)
                                             : decimals(p_mm[name[0] - 'X']);
    told += fmt::format("{}{}({})", told.empty() ? "" : ", ", name, value);
  }
  return {{told}, 0};
}

SeenServer::Answer SeenServer::scan(const Command& command) {
  const auto n = numbers_in(command);
  if (tool_.empty()) return {{}, kToolNotDefined};
  if (n.size() != 12 || !(n[11] > 0.0)) return {{}, kIncorrectArguments};
  const Vector3d center_W_mm = from_csy(three(n, 0));
  const Vector3d radius_W = from_csy(three(n, 3)) - center_W_mm;
  const bool inside = n[10] == 180.0;
  const int told_points = static_cast<int>(std::lround(std::abs(n[9]) / n[11]));
  const int fine = profile_.irregular_scans ? kFine : 1;
  ScanCircleCommand scan;
  scan.first_id = touches_;
  scan.center_W_mm = center_W_mm;
  scan.start_tip_W_mm = center_W_mm + radius_W +
                        (inside ? -1.0 : 1.0) * profile_.tip_radius_mm * radius_W.normalized();
  const Vector3d axis = from_csy(three(n, 6)) - from_csy(Vector3d::Zero());
  scan.axis_W = direction_on_grid(axis.normalized());
  scan.inside = inside;
  scan.sweep_rad = n[9] * core::kDegree;
  scan.points = told_points * fine;
  scan.approach_mm = parameters_.act("PtMeasPar.Approach");
  scan.search_mm = parameters_.act("PtMeasPar.Search");
  scan = on_grid(scan);
  Machine& machine = backend_.machine();
  const Vector3d away = (inside ? -1.0 : 1.0) * radius_W.normalized();
  if (const auto there = machine.move_to(on_grid_mm(scan.start_tip_W_mm + scan.approach_mm * away));
      !there) {
    return {{}, number_of(there.error(), command.method)};
  }
  const auto readings = machine.scan_circle(scan);
  if (!readings) return {{}, number_of(readings.error(), command.method)};
  touches_ += static_cast<std::int64_t>(readings->size());
  const auto within_a_degree =
      static_cast<std::size_t>(std::clamp(1.0 / (n[11] / fine), 1.0, static_cast<double>(fine)));
  const std::size_t offset = fine == 1 ? 0 : random_() % within_a_degree;
  Answer out;
  std::size_t numbers = kNumbersInALine;
  for (std::size_t i = 0; i < static_cast<std::size_t>(told_points); ++i) {
    if (fine > 1 && random_() % 50 == 0) continue;
    const std::size_t shift = fine == 1 ? 0 : random_() % 3;  // +-1 of 32: 3 % of a step
    const std::size_t at = i * static_cast<std::size_t>(fine) + offset + shift;
    if (at >= readings->size()) continue;
    const Vector3d p_mm = to_csy((*readings)[at].tip_W_mm);
    if (numbers + scan_report_.size() > kNumbersInALine) {
      out.data.emplace_back();
      numbers = 0;
    }
    for (const std::string& name : scan_report_) {
      const double value = name == "Q" ? 0.0 : p_mm[name[0] - 'X'];
      out.data.back() += (out.data.back().empty() ? "" : ",") + decimals(value);
      ++numbers;
    }
  }
  return out;
}

SeenServer::Answer SeenServer::align(const Command& command) {
  const auto n = numbers_in(command);
  if (n.size() != command.arguments.size() || (n.size() != 7 && n.size() != 14)) {
    return {{}, kIncorrectArguments};
  }
  std::vector<Alignment> wanted;
  for (std::size_t i = 0; i < n.size() / 7; ++i) {
    wanted.push_back({direction_on_grid(three(n, 6 * i).normalized()),
                      direction_on_grid(three(n, 6 * i + 3).normalized())});
  }
  if (backend_.table_angles_deg().empty()) return {{}, kIllegalCommand};
  const auto reached = backend_.align_part(wanted);
  if (!reached) return {{}, number_of(reached.error(), command.method)};
  std::string told;
  for (const Vector3d& v : *reached) told += (told.empty() ? "" : ", ") + vector_text(v);
  return {{told}, 0};
}

std::string SeenServer::place(std::vector<std::string> names, const Vector3d& tip_W_mm) const {
  std::sort(names.begin(), names.end());
  const Vector3d p_mm = to_csy(tip_W_mm);
  std::string out;
  for (const std::string& name : names) {
    const double value = name == "R" ? backend_.table_angles_deg()[0] : p_mm[name[0] - 'X'];
    out += fmt::format("{}{}({})", out.empty() ? "" : ", ", name, decimals(value));
  }
  return out;
}

Vector3d SeenServer::tip_now_W_mm(double now_s) const {
  if (!move_) return backend_.machine().position_W_mm();
  const double whole_s = move_->end_s - move_->begin_s;
  const double part = whole_s > 0.0 ? std::min(1.0, (now_s - move_->begin_s) / whole_s) : 1.0;
  return move_->from_W_mm + part * (move_->to_W_mm - move_->from_W_mm);
}

Vector3d SeenServer::to_csy(const Vector3d& p_W_mm) const {
  if (!in_part_csy_) return p_W_mm;
  return machine_to_csy(part_csy_).linear() * p_W_mm + part_csy_.x0_mm;
}

Vector3d SeenServer::from_csy(const Vector3d& p_mm) const {
  if (!in_part_csy_) return p_mm;
  return machine_to_csy(part_csy_).linear().transpose() * (p_mm - part_csy_.x0_mm);
}

SeenService::SeenService(Backend& backend, const SeenProfile& profile)
    : server_(backend, profile),
      listener_(*wire::TcpListener::open("127.0.0.1", 0)),
      port_(listener_.port()),
      thread_([this] {
        while (!ends_) {
          const auto client = listener_.accept(std::chrono::milliseconds(20));
          if (client && *client) serve(**client);
        }
      }) {}

SeenService::~SeenService() {
  ends_ = true;
  thread_.join();
}

void SeenService::serve(wire::LineTransport& client) {
  const auto now_s = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  while (!ends_) {
    const auto line = client.read_line(std::chrono::milliseconds(20));
    if (!line) break;
    if (*line) server_.receive({(*line)->text, (*line)->crlf}, now_s());
    server_.advance(now_s());
    for (const std::string& out : server_.take_output()) {
      if (!client.write_line(out)) break;
    }
  }
  server_.disconnect();
}

}  // namespace rondure::cmm::ipp
