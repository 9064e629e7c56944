#include "cmm/ipp_server/profile.h"

#include <algorithm>

#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp {

Profile as_recorded() {
  Profile out;
  out.name = "as-recorded";
  out.lacks = {"GetTemperatureSensors", "GetCoordSystem", "EnumAllProp", "SetTool",
               "ReadTemperatureSensor", "DisableUser",    "EnumProp",    "Tool.Id",
               "ReadAllTemperatures",   "EnableUser",     "GetPropE",    "Part",
               "GetSupportedCommands",  "Tool.Alignment", "FindTool",    "Scale",
               "ScanOnCircleHint",      "IsUserEnabled",  "FoundTool",   "Time",
               "StopAllDaemons",        "Simulation"};
  out.errors = {{kProtocolError, kIllegalCommand, "StartSession"},
                {kUnsupportedCommand, kIllegalCommand},
                {kNotRecognized, kIncorrectArguments},
                {kNotSupported, kIncorrectArguments},
                {kBadProperty, kIncorrectArguments}};
  out.numbers_in_a_line = 90;
  out.writes_five_decimals = out.sorts_values = out.adds_origin = true;
  out.quotes_machine_class = out.brackets_vectors = out.tells_tool_axis = true;
  out.abort_is_silent = true;
  return out;
}

Profile touches_only() {
  Profile out = as_recorded();
  out.name = "touches-only";
  for (const char* name : {"GetDMEVersion", "OnScanReport", "ScanOnCircle", "Tool.ScanPar"}) {
    out.lacks.emplace_back(name);
  }
  out.least_retract_mm = 0.0;
  return out;
}

bool Profile::knows(std::string_view asked) const {
  return std::none_of(lacks.begin(), lacks.end(), [asked](std::string_view lack) {
    return asked.starts_with(lack) && (asked.size() == lack.size() || asked[lack.size()] == '.');
  });
}

int Profile::told(int number, std::string_view method) const {
  const auto found = std::find_if(errors.begin(), errors.end(), [&](const ErrorNumber& error) {
    return error.number == number && (error.method.empty() || error.method == method);
  });
  return found == errors.end() ? number : found->told;
}

std::vector<std::string> Profile::in_order(std::vector<std::string> names) const {
  if (sorts_values) std::sort(names.begin(), names.end());
  return names;
}

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> kProfiles = {{}, as_recorded(), touches_only()};
  return kProfiles;
}

namespace {

constexpr double kAccel_mm_s2 = 1000.0;
constexpr double kMaxAccel_mm_s2 = 10'000.0;
constexpr double kMaxDistance_mm = 1000.0;

/// Cuts the suffix ".Act", ".Min", ".Max" or ".Def" off a name and returns it.
std::string_view take_aspect(std::string_view& name) {
  const std::size_t point = name.rfind('.');
  if (point == std::string_view::npos) return "Act";
  const std::string_view last = name.substr(point + 1);
  if (last != "Act" && last != "Min" && last != "Max" && last != "Def") return "Act";
  name = name.substr(0, point);
  return last;
}

}  // namespace

ToolParameters::ToolParameters(const ParameterDefaults& defaults, const Speeds& least,
                               const Speeds& greatest, double least_retract_mm) {
  const auto add = [this](std::string name, double def, double min, double max) {
    parameters_.push_back({std::move(name), def, min, max, def});
  };
  const Speeds& def = defaults.speeds;
  const double retract_mm = std::max(defaults.retract_mm, least_retract_mm);
  add("GoToPar.Speed", def.travel_mm_s, least.travel_mm_s, greatest.travel_mm_s);
  add("GoToPar.Accel", kAccel_mm_s2, 1.0, kMaxAccel_mm_s2);
  add("PtMeasPar.Speed", def.touch_mm_s, least.touch_mm_s, greatest.touch_mm_s);
  add("PtMeasPar.Accel", kAccel_mm_s2, 1.0, kMaxAccel_mm_s2);
  add("PtMeasPar.Approach", defaults.approach_mm, 0.0, kMaxDistance_mm);
  add("PtMeasPar.Search", defaults.search_mm, 0.0, kMaxDistance_mm);
  add("PtMeasPar.Retract", retract_mm, least_retract_mm, kMaxDistance_mm);
  add("ScanPar.Speed", def.scan_mm_s, least.scan_mm_s, greatest.scan_mm_s);
  add("ScanPar.Accel", kAccel_mm_s2, 1.0, kMaxAccel_mm_s2);
  add("ScanPar.Retract", retract_mm, least_retract_mm, kMaxDistance_mm);
}

std::optional<double> ToolParameters::get(std::string_view name) const {
  const std::string_view aspect = take_aspect(name);
  for (const Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    if (aspect == "Min") return parameter.min;
    if (aspect == "Max") return parameter.max;
    return aspect == "Def" ? parameter.def : parameter.act;
  }
  return std::nullopt;
}

ToolParameters::Set ToolParameters::set(std::string_view name, double value) {
  if (take_aspect(name) != "Act") return Set::kNoSuch;
  for (Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    parameter.act = std::clamp(value, parameter.min, parameter.max);
    return parameter.act == value ? Set::kDone : Set::kClamped;
  }
  return Set::kNoSuch;
}

void ToolParameters::reset() {
  for (Parameter& parameter : parameters_) parameter.act = parameter.def;
}

Speeds ToolParameters::speeds() const {
  return {act("GoToPar.Speed"), act("PtMeasPar.Speed"), act("ScanPar.Speed")};
}

std::vector<std::string> ToolParameters::names() const {
  std::vector<std::string> out;
  out.reserve(parameters_.size());
  for (const Parameter& parameter : parameters_) out.push_back(parameter.name);
  return out;
}

}  // namespace rondure::cmm::ipp
