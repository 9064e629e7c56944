#include "cmm/ipp_client/dialogue.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_client/internal/failure.h"

namespace rondure::cmm::ipp::client {
namespace {

// Values to request with a probed point. Not every server has all of them, so the first seven, four
// or three are requested.
constexpr auto kPointReport = std::to_array<std::string_view>(
    {"X", "Y", "Z", "ER", "Part.Temperature", "Scale.Temperature", "Time"});
constexpr auto kReportLengths = std::to_array<std::size_t>({7, 4, 3});

/// All items of a reply, including those inside a call.
void collect(std::span<const Item> items, std::vector<const Item*>& out) {
  for (const Item& item : items) {
    out.push_back(&item);
    collect(item.arguments, out);
  }
}

/// The name or string in an answer: DMEVersion("1.4"), GetMachineClass(CartCMM), "T1".
std::string word_of(const Reply& reply) {
  for (const Response& line : reply.data) {
    for (const Item& item : line.data) {
      if (const auto text = string_of(item)) return *text;
      if (item.kind == Item::Kind::kCall && item.arguments.size() == 1) {
        const Item& inner = item.arguments.front();
        if (inner.kind == Item::Kind::kName) return inner.text;
        if (inner.kind == Item::Kind::kNumber) return fmt::format("{:g}", inner.number);
      }
      if (item.kind == Item::Kind::kName) return item.text;
    }
  }
  return "";
}

/// The faults that the machine reports.
std::string fault_text(const Reply& reply) {
  std::string out;
  for (const Response& line : reply.data) {
    out += out.empty() ? "" : "; ";
    out += line.raw;
  }
  return out;
}

/// The first issue with temperatures of points and parts.
constexpr double kFirstWithTemperatures = 1.5;

/// Whether the answer to the first command reports more than an error state or session left by an
/// earlier client: a person must then act before a session starts.
bool waits_for_a_person(const ErrorReport& report) {
  return report.severity > kErrorState && report.number != kUseClearAllErrors &&
         !is_refusal(report);
}

/// Adds the earlier message of the machine to a failure, so that both are shown.
Failure with_earlier(Failure failure, const std::string& said) {
  if (!said.empty()) failure.what += fmt::format("; before that the machine said {}", said);
  return failure;
}

}  // namespace

const Item* find_value(const Reply& reply, std::string_view name) {
  std::vector<const Item*> all;
  for (const Response& line : reply.data) collect(line.data, all);
  const auto found = std::find_if(all.begin(), all.end(), [&](const Item* item) {
    return item->kind == Item::Kind::kCall && item->text == name;
  });
  return found == all.end() ? nullptr : *found;
}

std::optional<double> find_number(const Reply& reply, std::string_view name) {
  const Item* item = find_value(reply, name);
  return item == nullptr ? std::nullopt : single_number(*item);
}

core::Result<Eigen::Vector3d> find_point(const Reply& reply) {
  const auto x = find_number(reply, "X");
  const auto y = find_number(reply, "Y");
  const auto z = find_number(reply, "Z");
  if (x && y && z) return Eigen::Vector3d(*x, *y, *z);
  return core::machine_fault("the machine was asked for X, Y and Z and answered \"{}\"",
                             fault_text(reply).substr(0, 80));
}

std::vector<Eigen::Vector3d> find_vectors(const Reply& reply) {
  std::vector<const Item*> all;
  for (const Response& line : reply.data) collect(line.data, all);
  std::vector<Eigen::Vector3d> out;
  std::vector<double> bare;
  for (const Item* item : all) {
    if (item->kind == Item::Kind::kNumber) bare.push_back(item->number);
    const bool vector = item->kind == Item::Kind::kVector;
    if (const auto value = vector ? vector_of(*item) : std::nullopt) out.push_back(*value);
  }
  if (!out.empty()) return out;
  for (std::size_t i = 0; i + 2 < bare.size(); i += 3) {
    out.emplace_back(bare[i], bare[i + 1], bare[i + 2]);
  }
  return out;
}

core::Result<std::vector<Eigen::Vector3d>> scan_points(const Reply& reply) {
  std::vector<Eigen::Vector3d> out;
  for (const Response& line : reply.data) {
    const bool bare = std::all_of(line.data.begin(), line.data.end(), [](const Item& item) {
      return item.kind == Item::Kind::kNumber;
    });
    if (!bare || line.data.empty() || line.data.size() % 3 != 0) {
      return core::machine_fault("a line of the scan does not hold groups of X, Y, Z: \"{}\"",
                                 line.raw.substr(0, 80));
    }
    for (std::size_t i = 0; i < line.data.size(); i += 3) {
      out.emplace_back(line.data[i].number, line.data[i + 1].number, line.data[i + 2].number);
    }
  }
  return out;
}

Dialogue::Dialogue(std::unique_ptr<wire::LineTransport> line, const SessionOptions& options,
                   Milliseconds limit)
    : session_(std::move(line), options), limit_(limit) {}

Dialogue::~Dialogue() {
  if (started_ && session_.usable() && fault_.empty()) {
    (void)session_.call("EndSession", {}, limit_);
  }
}

Outcome<Reply> Dialogue::ask(std::string_view method, std::vector<Item> arguments) {
  auto reply = session_.call(method, std::move(arguments), limit_);
  if (!reply) settle(reply.error());
  return reply;
}

Outcome<Reply> Dialogue::move(std::string_view method, std::vector<Item> arguments,
                              Milliseconds limit) {
  auto reply = session_.call(method, std::move(arguments), limit, Session::Watch::kStop);
  if (!reply) settle(reply.error());
  return reply;
}

void Dialogue::settle(const Failure& failure) {
  if (failure.kind == Failure::Kind::kLine) return;
  const bool stopped = failure.kind == Failure::Kind::kStopped;
  const bool contact = !stopped && is_contact(failure.report);
  if (!stopped && !is_refusal(failure.report)) fault_ = failure.what;
  if (!fault_.empty() && !contact) return;
  if (auto cleared = session_.call("ClearAllErrors", {}, limit_); !cleared) {
    fault_ = cleared.error().what;
  }
}

core::Result<std::optional<Reply>> Dialogue::ask_if_known(std::string_view method,
                                                          std::vector<Item> arguments) {
  auto reply = ask(method, std::move(arguments));
  if (reply) return std::optional<Reply>(std::move(*reply));
  const Failure& failure = reply.error();
  if (failure.kind == Failure::Kind::kServer && is_unknown_here(failure.report)) {
    return std::optional<Reply>{};
  }
  return core::fail(error_of(failure, method));
}

core::Result<void> Dialogue::clear() {
  fault_.clear();
  if (auto cleared = session_.call("ClearAllErrors", {}, limit_); !cleared) {
    fault_ = cleared.error().what;
    return core::fail(error_of(cleared.error(), "taking back the errors of the machine"));
  }
  return check_state();
}

core::Result<void> Dialogue::fresh_session() {
  constexpr std::string_view kDoing = "opening a session";
  // A session that was not ended may still exist; a server in its error state refuses EndSession().
  auto ended = session_.call("EndSession", {}, limit_);
  std::string said;
  if (!ended && ended.error().kind == Failure::Kind::kServer) {
    if (waits_for_a_person(ended.error().report))
      return core::fail(error_of(ended.error(), kDoing));
    said = ended.error().what;
    ended = session_.call("ClearAllErrors", {}, limit_);
    if (ended) ended = session_.call("EndSession", {}, limit_);
  }
  if (!ended && ended.error().kind == Failure::Kind::kLine) {
    return core::fail(error_of(with_earlier(ended.error(), said), kDoing));
  }
  if (auto begun = session_.call("StartSession", {}, limit_); !begun) {
    return core::fail(error_of(with_earlier(begun.error(), said), kDoing));
  }
  started_ = true;
  return {};
}

core::Result<void> Dialogue::check_state() {
  const auto status = session_.call_event("GetErrStatusE", {}, limit_);
  if (!status && status.error().kind == Failure::Kind::kLine) {
    return core::fail(error_of(status.error(), "asking for the state of the machine"));
  }
  if (!status) {  // the state of such a server shows at the next command
    settle(status.error());
    return {};
  }
  if (find_number(*status, "ErrStatus").value_or(0.0) == 0.0) return {};
  const auto more = session_.call("GetXtdErrStatus", {}, limit_);
  fault_ = more ? fault_text(*more) : more.error().what;
  return core::machine_fault(
      "the machine is in its error state: {}; put that right at the machine, then start again",
      fault_);
}

core::Result<std::string> Dialogue::version() {
  TRY(const auto reply, ask_if_known("GetDMEVersion", {}));
  if (!reply) return std::string("before 1.4");
  const std::string version = word_of(*reply);
  if (version.starts_with("1.") || version.starts_with("2.")) return version;
  return core::machine_fault(
      "the server at {} speaks I++ DME version \"{}\", this program speaks 1.x and 2.x; connect "
      "another server",
      session_.peer(), version);
}

core::Result<void> Dialogue::choose_reports(Identity& identity) {
  bool chosen = false;
  for (const std::size_t length : kReportLengths) {
    if (length > 4 && !identity.has_temperatures) continue;
    std::vector<Item> items;
    for (std::size_t i = 0; i < length; ++i) items.push_back(call_item(kPointReport[i]));
    TRY(const auto taken, ask_if_known("OnPtMeasReport", std::move(items)));
    chosen = taken.has_value();
    if (!chosen) continue;
    identity.tells_time = length > 4;
    break;
  }
  if (!chosen) return core::machine_fault("the machine cannot report X, Y and Z of a probed point");
  TRY(const auto parameters, tool_may_have("ScanPar"));
  if (!parameters) {
    identity.no_scans = "its tool has no Tool.ScanPar";
    return {};
  }
  TRY(const auto scans,
      ask_if_known("OnScanReport", {call_item("X"), call_item("Y"), call_item("Z")}));
  identity.scans = scans.has_value();
  if (!identity.scans) identity.no_scans = "it does not take OnScanReport";
  return {};
}

core::Result<Identity> Dialogue::start() {
  TRY_DO(fresh_session());
  TRY_DO(check_state());
  Identity out;
  TRY(out.version, version());
  TRY(const auto kind, ask_if_known("GetMachineClass", {}));
  if (kind) out.machine_class = word_of(*kind);
  TRY_DO(choose_system("MachineCsy"));
  TRY(const auto tools, ask_if_known("EnumTools", {}));
  if (tools) {
    for (const Response& line : tools->data) {
      for (const Item& item : line.data) {
        const auto name = string_of(item);
        if (name && *name != "NoTool" && *name != "UnDefTool") out.tools.push_back(*name);
      }
    }
  }
  TRY(const auto simulated, is_simulator());
  out.simulated = simulated;
  out.has_temperatures =
      out.simulated || std::strtod(out.version.c_str(), nullptr) >= kFirstWithTemperatures;
  TRY_DO(choose_reports(out));
  return out;
}

core::Result<bool> Dialogue::is_simulator() {
  const auto list = tool_list();  // the list of our own server is complete
  if (!list) return core::fail(list.error());
  if (list->find("\"Id\"") == std::string::npos) return false;
  TRY(const auto id, ask_if_known("GetProp", {call_item("Tool.Id")}));
  if (!id || word_of(*id) != kSimulatorId) return false;
  TRY(const auto simulated, property("Simulation.NextTouch"));
  return simulated.has_value();
}

core::Result<std::string> Dialogue::tool_list() {
  if (!tool_list_) {
    TRY(const auto list, ask_if_known("EnumAllProp", {call_item("Tool")}));
    tool_list_ = list ? fault_text(*list) : "";
  }
  // A list without the parameters of a touch is unusable: no tool is active, or it is incomplete.
  return tool_list_->find("PtMeasPar") == std::string::npos ? std::string() : *tool_list_;
}

core::Result<bool> Dialogue::tool_may_have(std::string_view name) {
  TRY(const auto list, tool_list());
  return list.empty() || list.find(name) != std::string::npos;
}

core::Result<void> Dialogue::choose_system(std::string_view name) {
  const auto reply = ask("SetCoordSystem", {name_item(name)});
  if (!reply) {
    return core::fail(
        error_of(reply.error(), fmt::format("choosing the coordinate system {}", name)));
  }
  return {};
}

core::Result<Eigen::Vector3d> Dialogue::position_W_mm() {
  const auto reply = ask("Get", {call_item("X"), call_item("Y"), call_item("Z")});
  if (!reply) return core::fail(error_of(reply.error(), "asking where the tip stands"));
  return find_point(*reply);
}

core::Result<bool> Dialogue::is_homed() {
  const auto reply = ask("IsHomed");
  if (!reply) return core::fail(error_of(reply.error(), "asking whether the machine is homed"));
  return find_number(*reply, "IsHomed").value_or(0.0) != 0.0;
}

core::Result<std::string> Dialogue::active_tool() {
  const auto reply = ask("GetProp", {call_item("Tool.Name")});
  const bool none = !reply && reply.error().report.number == kToolNotDefined;
  if (none) return std::string();
  if (!reply) return core::fail(error_of(reply.error(), "asking for the tool"));
  const std::string name = word_of(*reply);
  return name == "NoTool" || name == "UnDefTool" ? std::string() : name;
}

core::Result<std::optional<double>> Dialogue::property(std::string_view name) {
  TRY(const auto reply, ask_if_known("GetProp", {call_item(name)}));
  return reply ? find_number(*reply, name) : std::nullopt;
}

core::Result<void> Dialogue::set(std::span<const std::pair<std::string_view, double>> values) {
  std::vector<Item> items;
  for (const auto& [name, value] : values) {
    const auto found = known_.find(name);
    if (found == known_.end() || found->second != value) items.push_back(call_item(name, {value}));
  }
  if (items.empty()) return {};
  const std::string text = to_text(items);
  const auto reply = ask("SetProp", std::move(items));
  if (!reply) return core::fail(error_of(reply.error(), fmt::format("setting {}", text)));
  for (const ErrorReport& warning : reply->warnings) {
    if (warning.number != kOutOfRange) continue;
    return core::fail_with(core::Code::kOutOfRange,
                           "setting {}: the machine says {}; choose values within its limits", text,
                           in_words(warning));
  }
  for (const auto& [name, value] : values) known_.insert_or_assign(std::string(name), value);
  return {};
}

core::Result<PointReport> Dialogue::point_of(const Reply& reply) const {
  TRY(const auto point, find_point(reply));
  PointReport out;
  out.tip_W_mm = point;
  out.tip_radius_mm = find_number(reply, "ER");
  if (const Item* normal = find_value(reply, "IJK")) out.normal_W = vector_of(*normal);
  out.temperature_degC = find_number(reply, "Part.Temperature");
  out.scale_temperature_degC = find_number(reply, "Scale.Temperature");
  out.time_s = find_number(reply, "Time");
  return out;
}

}  // namespace rondure::cmm::ipp::client
