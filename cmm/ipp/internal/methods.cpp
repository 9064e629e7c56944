#include "cmm/ipp/internal/methods.h"

#include <algorithm>
#include <array>

namespace rondure::cmm::ipp {
namespace {

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

}  // namespace

bool is_method(std::string_view name) {
  return std::find(kMethods.begin(), kMethods.end(), name) != kMethods.end();
}

bool is_event_method(std::string_view name) { return name.ends_with('E') && is_method(name); }

}  // namespace rondure::cmm::ipp
