#include "cmm/ipp_server/profile.h"

#include <algorithm>

#include "cmm/ipp/internal/errors.h"

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

}  // namespace rondure::cmm::ipp
