#include "cmm/ipp_client/survey.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_client/dialogue.h"
#include "cmm/ipp_client/internal/failure.h"

namespace rondure::cmm::ipp::client {
namespace {

constexpr auto kAsked = std::to_array<std::string_view>(
    {"Tool.GoToPar.Speed", "Tool.PtMeasPar.Speed", "Tool.PtMeasPar.Approach",
     "Tool.PtMeasPar.Search", "Tool.PtMeasPar.Retract", "Tool.ScanPar.Speed"});
// Values that a touch may report besides X, Y and Z.
constexpr auto kPointValues = std::to_array<std::string_view>(
    {"ER", "IJK", "Q", "Part.Temperature", "Scale.Temperature", "Time"});

/// All names and strings of a reply, at any depth: DMEVersion("1.4"), "T1", CartCMM.
void collect_words(std::span<const Item> items, std::vector<std::string>& out) {
  for (const Item& item : items) {
    if (item.kind == Item::Kind::kString || item.kind == Item::Kind::kName) {
      out.push_back(item.text);
    }
    if (item.kind == Item::Kind::kNumber) out.push_back(fmt::format("{:g}", item.number));
    collect_words(item.arguments, out);
  }
}

std::vector<std::string> words_of(const Reply& reply) {
  std::vector<std::string> out;
  for (const Response& line : reply.data) collect_words(line.data, out);
  return out;
}

bool is_no_tool(const std::string& name) { return name == "NoTool" || name == "UnDefTool"; }

/// The dialogue of a survey. Each request has a function of its own; a missing answer ends the
/// connection, and the requests after it are not sent.
class Surveyor {
 public:
  Surveyor(std::unique_ptr<wire::LineTransport> line, std::chrono::milliseconds limit)
      // AbortE is not sent: nothing moves for this client, so it could only stop another one's
      // motion.
      : session_(std::move(line), {limit, false}), limit_(limit) {}

  core::Result<Survey> run() {
    out_.peer = session_.peer();
    TRY_DO(begin());
    ask_state();
    if (out_.fault.empty()) {
      ask_who();
      ask_tools();
      ask_parameters();
      ask_place();
      ask_temperatures();
      ask_reports();
    }
    if (session_.usable()) (void)session_.call("EndSession", {}, limit_);
    if (!lost_.empty()) return core::machine_fault(lost_);
    return std::move(out_);
  }

 private:
  /// The answer; nothing when the server refuses the command or when the connection is lost.
  std::optional<Reply> ask(std::string_view method, std::vector<Item> arguments = {},
                           bool event = false) {
    if (!lost_.empty() || !out_.fault.empty()) return std::nullopt;
    const std::string text = to_text(call_item(method, arguments));
    auto reply = event ? session_.call_event(method, std::move(arguments), limit_)
                       : session_.call(method, std::move(arguments), limit_);
    if (reply) return std::move(*reply);
    note(text, reply.error());
    return std::nullopt;
  }

  void note(const std::string& command, const Failure& failure) {
    if (failure.kind != Failure::Kind::kServer) {
      lost_ = failure.what;
      return;
    }
    out_.refused.push_back({command, in_words(failure.report)});
    if (!is_refusal(failure.report)) {
      out_.fault = failure.what;
      return;
    }
    if (auto cleared = session_.call("ClearAllErrors", {}, limit_); !cleared) {
      (cleared.error().kind == Failure::Kind::kServer ? out_.fault : lost_) = cleared.error().what;
    }
  }

  core::Result<void> begin() {
    const auto begun = session_.call("StartSession", {}, limit_);
    if (begun) return {};
    const Failure& failure = begun.error();
    if (failure.kind != Failure::Kind::kServer) return core::machine_fault(failure.what);
    const bool open =
        failure.report.number == kProtocolError || failure.report.number == kIllegalCommand;
    return core::machine_fault(
        "{} begins no session: {}{}", session_.peer(), failure.what,
        open ? "; a session is open there: of another client, or of one that ended without a word; "
               "end that program, or let the controller end its session"
             : "; see what the controller reports and put it right");
  }

  void ask_state() {
    const auto status = ask("GetErrStatusE", {}, true);
    out_.tells_state = status.has_value();
    if (!status || find_number(*status, "ErrStatus").value_or(0.0) == 0.0) return;
    const auto more = session_.call("GetXtdErrStatus", {}, limit_);
    out_.fault = "the machine is in its error state";
    if (!more) return;
    for (const Response& line : more->data) out_.fault += "; " + line.raw;
  }

  void ask_who() {
    if (const auto listed = ask("GetSupportedCommands")) out_.commands = words_of(*listed);
    out_.version = first_word("GetDMEVersion");
    out_.machine_class = first_word("GetMachineClass");
    if (const auto homed = ask("IsHomed")) {
      out_.homed = find_number(*homed, "IsHomed").value_or(0.0) != 0.0;
    }
    if (const auto id = ask("GetProp", {call_item("Tool.Id")})) {
      const auto words = words_of(*id);
      out_.simulated = !words.empty() && words.front() == kSimulatorId;
    }
    // A run does not ask an older server either: it would refuse the names.
    has_temperatures_ = out_.simulated || std::strtod(out_.version.c_str(), nullptr) >= 1.5;
  }

  std::string first_word(std::string_view method) {
    if (!out_.may_know(method)) return {};
    const auto reply = ask(method);
    const auto words = reply ? words_of(*reply) : std::vector<std::string>{};
    return words.empty() ? std::string() : words.front();
  }

  std::optional<double> number(std::string_view property) {
    const auto reply = ask("GetProp", {call_item(property)});
    return reply ? find_number(*reply, property) : std::nullopt;
  }

  void ask_tools() {
    if (const auto tools = ask("EnumTools")) {
      out_.tools = words_of(*tools);
      std::erase_if(out_.tools, is_no_tool);
    }
    if (const auto active = ask("GetProp", {call_item("Tool.Name")})) {
      const auto words = words_of(*active);
      if (!words.empty() && !is_no_tool(words.front())) out_.tool = words.front();
    }
    out_.tip_radius_mm = number("Tool.AvrRadius");
  }

  void ask_parameters() {
    for (const std::string_view name : kAsked) {
      Survey::Parameter parameter{std::string(name), {}, {}, {}};
      parameter.value = number(name);
      if (!parameter.value) continue;
      parameter.least = number(parameter.name + ".Min");
      parameter.greatest = number(parameter.name + ".Max");
      out_.parameters.push_back(std::move(parameter));
    }
  }

  void ask_place() {
    out_.frame = first_word("GetCoordSystem");
    if (const auto place = ask("Get", {call_item("X"), call_item("Y"), call_item("Z")})) {
      if (const auto tip = find_point(*place)) out_.tip_mm = *tip;
    }
    if (const auto table = ask("Get", {call_item("R")})) out_.table_deg = find_number(*table, "R");
  }

  void ask_temperatures() {
    if (!has_temperatures_) return;
    out_.part_degC = number("Part.Temperature");
    if (!out_.may_know("GetTemperatureSensors")) return;
    if (const auto sensors = ask("GetTemperatureSensors")) out_.sensors = words_of(*sensors);
  }

  /// Finds the possible values of reports; EndSession restores the previous choice.
  void ask_reports() {
    const std::vector<Item> place = {call_item("X"), call_item("Y"), call_item("Z")};
    if (ask("OnPtMeasReport", place)) out_.point_values = {"X", "Y", "Z"};
    for (const std::string_view name : kPointValues) {
      const bool newer = name.find("Temperature") != std::string_view::npos || name == "Time";
      if (newer && !has_temperatures_) continue;
      std::vector<Item> names = place;
      names.push_back(call_item(name));
      if (ask("OnPtMeasReport", std::move(names))) out_.point_values.emplace_back(name);
    }
    out_.scans = ask("OnScanReport", place).has_value();
  }

  Session session_;
  std::chrono::milliseconds limit_;
  Survey out_;
  bool has_temperatures_ = false;  ///< Also the time, with points: since issue 1.5.
  std::string lost_;               ///< Why no further answers arrive.
};

}  // namespace

bool Survey::has_rotary_table() const {
  return machine_class.find("RotaryTable") != std::string::npos;
}

bool Survey::may_know(std::string_view command) const {
  return commands.empty() || std::find(commands.begin(), commands.end(), command) != commands.end();
}

const Survey::Parameter* Survey::parameter(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [name](const Parameter& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

core::Result<Survey> survey(std::unique_ptr<wire::LineTransport> line,
                            std::chrono::milliseconds limit) {
  return Surveyor(std::move(line), limit).run();
}

}  // namespace rondure::cmm::ipp::client
