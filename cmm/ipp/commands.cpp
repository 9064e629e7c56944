#include "cmm/ipp/grammar.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp/numbers.h"

namespace rondure::cmm::ipp {
namespace {

/// The methods of the language (all issues up to 1.5, with known additions); a server need not
/// support all of them. Names are case-sensitive; those for the fast queue end in E.
constexpr auto kMethods = std::to_array<std::string_view>({
    "AbortE",
    "AlignPart",
    "AlignTool",
    "CenterPart",
    "ChangeTool",
    "ClearAllErrors",
    "DisableUser",
    "EnableRotaryTableVarCsy",
    "EnableUser",
    "EndSession",
    "EnumAllProp",
    "EnumProp",
    "EnumTools",
    "FindTool",
    "Get",
    "GetCoordSystem",
    "GetCsyTransformation",
    "GetDMEVersion",
    "GetErrStatusE",
    "GetErrorInfo",
    "GetMachineClass",
    "GetProp",
    "GetPropE",
    "GetSupportedCommands",
    "GetTemperatureSensors",
    "GetXtdErrStatus",
    "GoTo",
    "Home",
    "IsHomed",
    "IsUserEnabled",
    "LockAxis",
    "LockPosition",
    "OnMoveReportE",
    "OnPtMeasReport",
    "OnScanReport",
    "PtMeas",
    "ReQualify",
    "ReadAllTemperatures",
    "ReadTemperatureSensor",
    "ScanInCylEndIsPlane",
    "ScanInCylEndIsSphere",
    "ScanInPlaneEndIsCyl",
    "ScanInPlaneEndIsPlane",
    "ScanInPlaneEndIsSphere",
    "ScanOnCircle",
    "ScanOnCircleHint",
    "ScanOnCurve",
    "ScanOnCurveDensity",
    "ScanOnCurveHint",
    "ScanOnHelix",
    "ScanOnLine",
    "ScanOnLineHint",
    "ScanUnknownDensity",
    "ScanUnknownHint",
    "SetCoordSystem",
    "SetCsyTransformation",
    "SetProp",
    "SetTool",
    "StartSession",
    "StopAllDaemons",
    "StopDaemon",
    "TiltCenterPart",
    "TiltPart",
});

tl::unexpected<Refusal> refuse(int number, std::optional<Tag> tag, std::string what) {
  return tl::unexpected(Refusal{number, tag, std::move(what)});
}

/// Checks the requirements for an answer to a tag.
tl::expected<Tag, Refusal> read_head(std::string_view line) {
  if (line.size() > kMaxLineLength) {
    return refuse(
        kProtocolError, {},
        fmt::format("a line of {} characters; {} are allowed", line.size(), kMaxLineLength));
  }
  if (!is_plain(line)) return refuse(kIllegalCharacter, {}, "a character outside ASCII 32 to 126");
  const auto tag = read_tag(line.substr(0, kTagLength));
  if (!tag || *tag == kUnsolicited) {
    return refuse(kIllegalTag, {}, "the line does not begin with a tag of five characters");
  }
  if (line.size() <= kTagLength || line[kTagLength] != ' ') {
    return refuse(kNoSpace, {}, "no space behind the tag");
  }
  return *tag;
}

}  // namespace

tl::expected<Command, Refusal> parse_command(std::string_view line) {
  TRY(const auto tag, read_head(line));
  ItemReader reader(line.substr(kTagLength + 1), ItemReader::Manner::kStrict);
  Command out;
  out.tag = tag;
  out.method = reader.read_name(false);
  if (out.method.empty()) return refuse(kIncorrectArguments, tag, "no method behind the tag");
  if (tag.event && !out.method.ends_with('E')) {
    return refuse(kIllegalTag, {}, fmt::format("{} is no event command", out.method));
  }
  if (std::find(kMethods.begin(), kMethods.end(), out.method) == kMethods.end()) {
    return refuse(kIllegalCommand, tag, fmt::format("there is no method {}", out.method));
  }
  if (!tag.event && out.method.ends_with('E')) {
    return refuse(kIllegalTag, tag, fmt::format("{} needs an event tag", out.method));
  }
  auto arguments = reader.read_arguments(1);
  if (!arguments) return refuse(arguments.error().number, tag, std::move(arguments.error().what));
  if (!reader.at_end()) {
    return refuse(kIncorrectArguments, tag, "text behind the last parenthesis");
  }
  out.arguments = std::move(*arguments);
  return out;
}

tl::expected<Command, Refusal> parse_command(const RawLine& line) {
  if (!line.crlf) return refuse(kIllegalCharacter, {}, "the line ends without CR");
  return parse_command(std::string_view(line.text));
}

std::string method_text(const Command& command, NumberForm form) {
  return fmt::format("{}({})", command.method,
                     to_text(std::span<const Item>(command.arguments), form));
}

std::string to_line(const Command& command, NumberForm form) {
  return fmt::format("{} {}", to_text(command.tag), method_text(command, form));
}

}  // namespace rondure::cmm::ipp
