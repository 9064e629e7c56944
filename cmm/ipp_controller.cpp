#include "cmm/ipp_controller.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cmm/ipp_errors.h"

namespace rondure::cmm::ipp {
namespace {

using Arguments = std::vector<Item>;

constexpr std::array<std::string_view, 5> kMotions = {"Home", "GoTo", "PtMeas", "ScanOnCircle",
                                                      "AlignPart"};
constexpr std::array<std::string_view, 9> kOfServer = {
    "StartSession",    "EndSession",    "AbortE",     "ClearAllErrors", "GetErrStatusE",
    "GetXtdErrStatus", "OnMoveReportE", "StopDaemon", "StopAllDaemons"};
constexpr std::size_t kMaxNames = 64;  // in one command, so that an answer fits into a line
constexpr double kMaxOrigin_mm = 1e6;  // of a coordinate system

tl::unexpected<Failure> fail(int number, std::string what) {
  return tl::unexpected(Failure{number, std::move(what)});
}

tl::unexpected<Failure> wrong_arguments(std::string_view wanted) {
  return fail(kIncorrectArguments, fmt::format("the arguments are not {}", wanted));
}

Outcome one_line(Item item) { return Reply{{{std::move(item)}}, 0}; }

double as_number(bool value) { return value ? 1.0 : 0.0; }

/// The names of X(), Y(), IJK(); nothing when one of the arguments is anything else.
std::optional<std::vector<std::string>> empty_calls(const Arguments& arguments) {
  std::vector<std::string> out;
  for (const Item& item : arguments) {
    if (item.kind != Item::Kind::kCall || !item.arguments.empty()) return std::nullopt;
    out.push_back(item.text);
  }
  if (out.empty() || out.size() > kMaxNames) return std::nullopt;
  return out;
}

bool is_one_of(std::string_view name, std::span<const std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 9> kTouchValues = {
    "X", "Y", "Z", "IJK", "ER", "Q", "Part.Temperature", "Scale.Temperature", "Time"};
constexpr std::array<std::string_view, 5> kScanValues = {"X", "Y", "Z", "ER", "Q"};

}  // namespace

Controller::Controller(Backend& backend, const ControllerOptions& options)
    : backend_(backend),
      options_(options),
      parameters_(options.defaults, backend.machine().capabilities().least,
                  backend.machine().capabilities().greatest) {
  if (auto status = machine().status()) tool_ = status->tool;
  begin_session();
}

void Controller::begin_session() {
  touch_report_ = {"X", "Y", "Z"};
  scan_report_ = {"X", "Y", "Z", "Q"};
}

core::Result<void> Controller::recover() { return machine().recover(); }

bool Controller::is_motion(std::string_view method) { return is_one_of(method, kMotions); }

const std::vector<Controller::Entry>& Controller::entries() {
  static const std::vector<Entry> kEntries = {
      {"GetDMEVersion", &Controller::get_version},
      {"GetMachineClass", &Controller::get_machine_class},
      {"IsHomed", &Controller::is_homed_query},
      {"EnableUser", &Controller::enable_user},
      {"DisableUser", &Controller::disable_user},
      {"IsUserEnabled", &Controller::is_user_enabled_query},
      {"GetErrorInfo", &Controller::get_error_info},
      {"GetSupportedCommands", &Controller::get_supported_commands},
      {"Get", &Controller::get_position},
      {"OnPtMeasReport", &Controller::set_touch_report},
      {"OnScanReport", &Controller::set_scan_report},
      {"ScanOnCircleHint", &Controller::take_hint},
      {"GetTemperatureSensors", &Controller::temperature_sensors},
      {"ReadTemperatureSensor", &Controller::read_temperature},
      {"ReadAllTemperatures", &Controller::read_all_temperatures},
      {"SetCoordSystem", &Controller::set_coord_system},
      {"GetCoordSystem", &Controller::get_coord_system},
      {"SetCsyTransformation", &Controller::set_transformation},
      {"GetCsyTransformation", &Controller::get_transformation},
      {"EnumTools", &Controller::enum_tools},
      {"ChangeTool", &Controller::change_tool},
      {"SetTool", &Controller::change_tool},
      {"FindTool", &Controller::find_tool},
      {"GetProp", &Controller::get_properties},
      {"GetPropE", &Controller::get_properties},
      {"SetProp", &Controller::set_properties},
      {"EnumProp", &Controller::enum_properties},
      {"EnumAllProp", &Controller::enum_all_properties},
  };
  return kEntries;
}

Outcome Controller::execute(const Command& command) {
  for (const Entry& entry : entries()) {
    if (entry.method == command.method) return (this->*entry.handler)(command.arguments);
  }
  return fail(kUnsupportedCommand,
              fmt::format("{} is not supported by this server", command.method));
}

bool Controller::is_homed() {
  const auto status = machine().status();
  return status && status->homed;
}

std::vector<std::string> Controller::in_order(std::vector<std::string> names) const {
  if (seen()) std::sort(names.begin(), names.end());
  return names;
}

Outcome Controller::get_version(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  return one_line(call_item("DMEVersion", {string_item(options_.version)}));
}

Outcome Controller::get_machine_class(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  const std::string_view name =
      backend_.table_angles_deg().empty() ? "CartCMM" : "CartCMMWithRotaryTable";
  return one_line(call_item("GetMachineClass", {seen() ? string_item(name) : name_item(name)}));
}

Outcome Controller::is_homed_query(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  return one_line(call_item("IsHomed", {as_number(is_homed())}));
}

Outcome Controller::enable_user(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  user_enabled_ = true;
  return Reply{};
}

Outcome Controller::disable_user(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  user_enabled_ = false;
  return Reply{};
}

Outcome Controller::is_user_enabled_query(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  return one_line(call_item("IsUserEnabled", {as_number(user_enabled_)}));
}

Outcome Controller::get_error_info(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kNumber) {
    return wrong_arguments("(number)");
  }
  const double number = arguments[0].number;
  const bool whole = number >= 0.0 && number <= 9999.0;
  const ErrorEntry* entry = whole ? find_error(static_cast<int>(number)) : nullptr;
  if (entry == nullptr || entry->number != number) {
    return fail(kNotRecognized, fmt::format("there is no error {}", number));
  }
  return one_line(string_item(entry->text));
}

Outcome Controller::get_supported_commands(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  Reply out;
  for (const Entry& entry : entries()) out.lines.push_back({string_item(entry.method)});
  for (const std::string_view method : kMotions) out.lines.push_back({string_item(method)});
  for (const std::string_view method : kOfServer) out.lines.push_back({string_item(method)});
  return out;
}

tl::expected<std::vector<Item>, Failure> Controller::position_report(
    const std::vector<std::string>& names, const Eigen::Vector3d& tip_W_mm) const {
  const Eigen::Vector3d p_mm = X_CW_ * tip_W_mm;
  const std::vector<double> angles_deg = backend_.table_angles_deg();
  std::vector<Item> out;
  if (names.size() > kMaxNames) return fail(kIncorrectArguments, "too many names");
  for (const std::string& name : in_order(names)) {
    if (name == "X" || name == "Y" || name == "Z") {
      out.push_back(call_item(name, {p_mm[name[0] - 'X']}));
    } else if (name == "R" && !angles_deg.empty()) {
      out.push_back(call_item(name, {angles_deg[0]}));
    } else {
      return fail(kNotRecognized, fmt::format("{} is no value of the position", name));
    }
  }
  return out;
}

Outcome Controller::get_position(const Arguments& arguments) {
  const auto names = empty_calls(arguments);
  if (!names) return wrong_arguments("(X(), Y(), ...)");
  auto values = position_report(*names, machine().position_W_mm());
  if (!values) return tl::unexpected(std::move(values.error()));
  return Reply{{std::move(*values)}, 0};
}

Outcome Controller::set_touch_report(const Arguments& arguments) {
  const auto names = empty_calls(arguments);
  if (!names) return wrong_arguments("(X(), Y(), Z(), IJK(), ER(), Q())");
  for (const std::string& name : *names) {
    if (!is_one_of(name, kTouchValues)) {
      return fail(kNotRecognized, fmt::format("{} is no value of a touch", name));
    }
  }
  touch_report_ = *names;
  return Reply{};
}

Outcome Controller::set_scan_report(const Arguments& arguments) {
  const auto names = empty_calls(arguments);
  if (!names) return wrong_arguments("(X(), Y(), Z(), Q())");
  for (const std::string& name : *names) {
    if (!is_one_of(name, kScanValues)) {
      return fail(kNotRecognized, fmt::format("{} is no column of a scan", name));
    }
  }
  scan_report_ = *names;
  return Reply{};
}

Outcome Controller::take_hint(const Arguments& arguments) {
  const bool numbers = std::all_of(arguments.begin(), arguments.end(), [](const Item& item) {
    return item.kind == Item::Kind::kNumber;
  });
  if (arguments.size() != 2 || !numbers) return wrong_arguments("(displacement, form)");
  return Reply{};  // the simulated scan follows any form without being told
}

Outcome Controller::temperature_sensors(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  return Reply{{{string_item("Part")}, {string_item("Scale")}}, 0};
}

Outcome Controller::read_temperature(const Arguments& arguments) {
  const auto sensor = arguments.size() == 1 ? string_of(arguments[0]) : std::nullopt;
  if (!sensor) return wrong_arguments("(\"sensor\")");
  const double part_degC =
      last_reading_ ? last_reading_->temperature_degC : options_.temperature_degC;
  const double scale_degC =
      last_reading_ ? last_reading_->scale_temperature_degC : options_.temperature_degC;
  if (*sensor == "Part") return one_line(call_item("ReadTemperatureSensor", {part_degC}));
  if (*sensor == "Scale") return one_line(call_item("ReadTemperatureSensor", {scale_degC}));
  return fail(kNotRecognized, fmt::format("there is no sensor \"{}\"", *sensor));
}

Outcome Controller::read_all_temperatures(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  Reply out;
  for (const char* sensor : {"Part", "Scale"}) {
    auto read = read_temperature({string_item(sensor)});
    if (!read) return read;
    out.lines.push_back({call_item(sensor, read->lines[0][0].arguments)});
  }
  return out;
}

Outcome Controller::set_coord_system(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kName) {
    return wrong_arguments("(MachineCsy or PartCsy)");
  }
  const std::string& name = arguments[0].text;
  if (name != "MachineCsy" && name != "PartCsy") {
    const bool known = name == "MoveableMachineCsy" || name == "MultipleArmCsy";
    return fail(known ? kNotSupported : kNotRecognized,
                fmt::format("the coordinate system {} is not there", name));
  }
  csy_ = name;
  X_CW_ = name == "MachineCsy"
              ? Eigen::Isometry3d::Identity()
              : machine_to_csy(part_csy_, seen() ? TranslationReading::kAdded
                                                 : TranslationReading::kSubtracted);
  return Reply{};
}

Outcome Controller::get_coord_system(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  return one_line(call_item("CoordSystem", {name_item(csy_)}));
}

Outcome Controller::set_transformation(const Arguments& arguments) {
  std::array<double, 6> n{};
  const bool named = arguments.size() == 7 && arguments[0].kind == Item::Kind::kName;
  for (std::size_t i = 0; named && i < n.size(); ++i) {
    if (arguments[i + 1].kind != Item::Kind::kNumber) return wrong_arguments("six numbers");
    n[i] = arguments[i + 1].number;
  }
  if (!named) return wrong_arguments("(PartCsy, x0, y0, z0, theta, psi, phi)");
  if (arguments[0].text != "PartCsy") {
    return fail(kNotSupported, fmt::format("{} cannot be set", arguments[0].text));
  }
  if (n[3] < 0.0 || n[3] > 180.0) {
    return fail(kThetaOutOfRange, fmt::format("theta of {} deg is outside 0..180 deg", n[3]));
  }
  if (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) > kMaxOrigin_mm) {
    return fail(kBadArgument, fmt::format("an origin beyond {} mm", kMaxOrigin_mm));
  }
  part_csy_ = {{n[0], n[1], n[2]}, n[3], n[4], n[5]};
  return csy_ == "PartCsy" ? set_coord_system({name_item(csy_)}) : Reply{};
}

Outcome Controller::get_transformation(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kName ||
      arguments[0].text != "PartCsy") {
    return wrong_arguments("(PartCsy)");
  }
  const CsyTransformation& t = part_csy_;
  return one_line(call_item("GetCsyTransformation", {t.x0_mm.x(), t.x0_mm.y(), t.x0_mm.z(),
                                                     t.theta_deg, t.psi_deg, t.phi_deg}));
}

}  // namespace rondure::cmm::ipp
