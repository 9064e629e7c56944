#include "cmm/ipp_server/controller.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/internal/arguments.h"
#include "core/units.h"

namespace rondure::cmm::ipp {
namespace {

constexpr std::array<std::string_view, 5> kMotions = {"Home", "GoTo", "PtMeas", "ScanOnCircle",
                                                      "AlignPart"};
constexpr std::array<std::string_view, 9> kOfServer = {
    "StartSession",    "EndSession",    "AbortE",     "ClearAllErrors", "GetErrStatusE",
    "GetXtdErrStatus", "OnMoveReportE", "StopDaemon", "StopAllDaemons"};
constexpr double kMaxOrigin_mm = 1e6;  // limit for a coordinate system

}  // namespace

Eigen::Isometry3d machine_to_csy(const CsyTransformation& transformation) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  // The axes turn, so the coordinates of a fixed point turn in the opposite sense.
  const Eigen::Matrix3d axes =
      (AngleAxisd(transformation.psi_deg * core::kDegree, Vector3d::UnitZ()) *
       AngleAxisd(transformation.theta_deg * core::kDegree, Vector3d::UnitX()) *
       AngleAxisd(transformation.phi_deg * core::kDegree, Vector3d::UnitZ()))
          .toRotationMatrix();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = axes.transpose();
  out.translation() = -(out.linear() * transformation.x0_mm);
  return out;
}

CsyTransformation transformation_to(const Eigen::Isometry3d& X_WC, bool adds_origin) {
  const Eigen::Matrix3d R = X_WC.linear();
  const double tilt = std::hypot(R(0, 2), R(1, 2));
  const bool upright = tilt < 1e-12;  // then psi alone turns
  const double psi = upright ? std::atan2(R(1, 0), R(0, 0)) : std::atan2(R(0, 2), -R(1, 2));
  const double phi = upright ? 0.0 : std::atan2(R(2, 0), R(2, 1));
  CsyTransformation out;
  out.x0_mm = X_WC.translation();
  if (adds_origin) out.x0_mm = X_WC.inverse().translation();
  out.theta_deg = std::atan2(tilt, R(2, 2)) / core::kDegree;
  out.psi_deg = psi / core::kDegree;
  out.phi_deg = phi / core::kDegree;
  return out;
}

Controller::Controller(Backend& backend, const ControllerOptions& options)
    : backend_(backend),
      options_(options),
      parameters_(options.defaults, backend.machine().capabilities().least,
                  backend.machine().capabilities().greatest, options.profile.least_retract_mm) {
  if (options.profile.writes_five_decimals) options_.numbers = NumberForm::kFiveDecimals;
  if (auto status = machine().status()) tool_ = status->tool;
  part_csy_ = transformation_to(backend.part_system(), options.profile.adds_origin);
  begin_session();
}

void Controller::begin_session() {
  touch_report_ = {"X", "Y", "Z"};
  scan_report_ = options_.profile.in_order({"X", "Y", "Z", "Q"});
}

bool Controller::is_motion(std::string_view method) { return is_one_of(method, kMotions); }

const std::vector<Controller::Entry>& Controller::entries() {
  static const std::vector<Entry> kEntries = {
      {"GetDMEVersion",
       [](Controller& c, const Arguments&) {
         return one_line(call_item("DMEVersion", {string_item(c.options_.version)}));
       },
       false},
      {"GetMachineClass",
       [](Controller& c, const Arguments&) {
         const bool table = !c.backend_.table_angles_deg().empty();
         const char* name = table ? "CartCMMWithRotaryTable" : "CartCMM";
         return one_line(call_item(
             "GetMachineClass",
             {c.options_.profile.quotes_machine_class ? string_item(name) : name_item(name)}));
       },
       false},
      {"IsHomed",
       [](Controller& c, const Arguments&) { return one_line(flag_item("IsHomed", c.is_homed())); },
       false},
      {"EnableUser",
       [](Controller& c, const Arguments&) {
         c.user_enabled_ = true;
         return Outcome(Reply{});
       },
       false},
      {"DisableUser",
       [](Controller& c, const Arguments&) {
         c.user_enabled_ = false;
         return Outcome(Reply{});
       },
       false},
      {"IsUserEnabled",
       [](Controller& c, const Arguments&) {
         return one_line(flag_item("IsUserEnabled", c.user_enabled_));
       },
       false},
      {"GetErrorInfo", &Controller::get_error_info},
      {"GetSupportedCommands", &Controller::get_supported_commands, false},
      {"Get", &Controller::get_position},
      {"OnPtMeasReport", &Controller::set_touch_report},
      {"OnScanReport", &Controller::set_scan_report},
      {"ScanOnCircleHint", &Controller::take_hint},
      {"GetTemperatureSensors", &Controller::temperature_sensors, false},
      {"ReadTemperatureSensor", &Controller::read_temperature},
      {"ReadAllTemperatures", &Controller::read_all_temperatures, false},
      {"SetCoordSystem", &Controller::set_coord_system},
      {"GetCoordSystem",
       [](Controller& c, const Arguments&) {
         return one_line(call_item("CoordSystem", {name_item(c.csy_)}));
       },
       false},
      {"SetCsyTransformation", &Controller::set_transformation},
      {"GetCsyTransformation", &Controller::get_transformation},
      {"EnumTools", &Controller::enum_tools, false},
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
    if (entry.method != command.method) continue;
    if (!entry.takes_arguments && !command.arguments.empty()) return wrong_arguments("()");
    return entry.handler(*this, command.arguments);
  }
  return refusal(kUnsupportedCommand,
                 fmt::format("{} is not supported by this server", command.method));
}

bool Controller::is_homed() {
  const auto status = machine().status();
  return status && status->homed;
}

Outcome Controller::get_error_info(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kNumber) {
    return wrong_arguments("(number)");
  }
  const double number = arguments[0].number;
  const bool whole = number >= 0.0 && number <= 9999.0;
  const ErrorEntry* entry = whole ? find_error(static_cast<int>(number)) : nullptr;
  if (entry == nullptr || entry->number != number) {
    return refusal(kNotRecognized, fmt::format("there is no error {}", number));
  }
  return one_line(string_item(entry->text));
}

Outcome Controller::get_supported_commands(const Arguments&) {
  Reply out;
  const auto add = [&](std::string_view method) {
    if (options_.profile.knows(method)) out.lines.push_back({string_item(method)});
  };
  for (const Entry& entry : entries()) add(entry.method);
  for (const std::string_view method : kMotions) add(method);
  for (const std::string_view method : kOfServer) add(method);
  return out;
}

Outcome Controller::take_hint(const Arguments& arguments) {
  const bool numbers = std::all_of(arguments.begin(), arguments.end(), [](const Item& item) {
    return item.kind == Item::Kind::kNumber;
  });
  if (arguments.size() != 2 || !numbers) return wrong_arguments("(displacement, form)");
  return Reply{};  // the simulated scan follows any form without such hints
}

Outcome Controller::set_coord_system(const Arguments& arguments) {
  if (arguments.size() != 1 || arguments[0].kind != Item::Kind::kName) {
    return wrong_arguments("(MachineCsy or PartCsy)");
  }
  const std::string& name = arguments[0].text;
  if (name != "MachineCsy" && name != "PartCsy") {
    const bool known = name == "MoveableMachineCsy" || name == "MultipleArmCsy";
    return refusal(known ? kNotSupported : kNotRecognized,
                   fmt::format("the coordinate system {} is not there", name));
  }
  csy_ = name;
  X_CW_ = name == "MachineCsy" ? Eigen::Isometry3d::Identity() : machine_to_csy(part_csy_);
  if (name == "PartCsy" && options_.profile.adds_origin) X_CW_.translation() = part_csy_.x0_mm;
  return Reply{};
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
    return refusal(kNotSupported, fmt::format("{} cannot be set", arguments[0].text));
  }
  if (n[3] < 0.0 || n[3] > 180.0) {
    return refusal(kThetaOutOfRange, fmt::format("theta of {} deg is outside 0..180 deg", n[3]));
  }
  if (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) > kMaxOrigin_mm) {
    return refusal(kBadArgument, fmt::format("an origin beyond {} mm", kMaxOrigin_mm));
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
