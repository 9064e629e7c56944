#include "cmm/ipp_client/internal/failure.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp::client {
namespace {

constexpr int kCannotMeasure = 2002;  // Type of probe does not allow this operation
constexpr int kExcessiveForce = 2001;

constexpr auto kRefusals = std::to_array<int>({
    kUnsupportedCommand,
    kIncorrectArguments,
    kOutOfRange,
    kNotRecognized,
    kNotSupported,
    kIllegalCommand,
    kBadContext,
    kBadArgument,
    kBadProperty,
    kNoDaemons,
    kNoSuchDaemon,
    kDaemonExists,
    kNoTouch,
    1004,
    kSurfaceNotFound,
    kThetaOutOfRange,
    kOutOfVolume,
    kNoNorm,
    1012,
    1013,
    1014,
    kToolNotFound,
    kToolNotDefined,
    1504,
    1505,
    1506,
    1507,
    kCannotMeasure,
    kMoveOutOfLimits,
    kAngleOutOfRange,
    kNotAligned,
});

constexpr auto kUnknown =
    std::to_array<int>({kUnsupportedCommand, kIncorrectArguments, kNotRecognized, kNotSupported,
                        kIllegalCommand, kBadArgument, kBadProperty, kToolNotDefined});

/// The remedy for an error number.
std::string_view advice(int number) {
  switch (number) {
    case 500:
      return "release the emergency stop once the machine is safe";
    case 503:
    case 2503:
      return "the controller has a fault, see its own display and its service manual";
    case kUseClearAllErrors:
    case kMachineInErrorState:
      return "see what the controller reports and put it right";
    case 1009:
      return "check the air supply";
    case 1501:
      return "check that the probe is armed and its cable";
    case kToolNotFound:
    case kToolNotDefined:
      return "name a tool of the machine (machine.tool)";
    case 2000:
      return "qualify the tool on the machine";
    case kCollision:
    case kExcessiveForce:
    case 1001:
      return "look where the tip stands before anything moves";
    case kNotAligned:
      return "the rotary table did not reach its angle, see that it is free";
    default:
      return "";
  }
}

core::Code code_of(int number) {
  switch (number) {
    case kNoTouch:
    case kSurfaceNotFound:
      return core::Code::kNoTouch;
    case 1001:
    case kExcessiveForce:
    case kCollision:
      return core::Code::kCollision;
    case kOutOfVolume:
    case kMoveOutOfLimits:
      return core::Code::kUnreachable;
    case kAngleOutOfRange:
      return core::Code::kPoseRange;
    default:
      return core::Code::kMachine;
  }
}

template <class List>
bool holds(const List& list, int number) {
  return std::find(list.begin(), list.end(), number) != list.end();
}

}  // namespace

bool is_refusal(const ErrorReport& report) {
  return report.severity < 9 && holds(kRefusals, report.number);
}

bool is_contact(const ErrorReport& report) {
  return code_of(report.number) == core::Code::kCollision;
}

bool is_unknown_here(const ErrorReport& report) { return holds(kUnknown, report.number); }

core::Error error_of(const Failure& failure, std::string_view doing) {
  switch (failure.kind) {
    case Failure::Kind::kStopped:
      return {core::Code::kStopped, fmt::format("{} was stopped by the operator", doing), {}};
    case Failure::Kind::kServer:
      break;
    case Failure::Kind::kLine:
    default:
      return {core::Code::kMachine,
              fmt::format("{}: {}; the machine ends the motion it was told last, then it stands "
                          "still: check server, network and controller",
                          doing, failure.what),
              {}};
  }
  const std::string_view help = advice(failure.report.number);
  return {code_of(failure.report.number),
          fmt::format("{}: the machine says {}{}{}", doing, failure.what, help.empty() ? "" : "; ",
                      help),
          {}};
}

}  // namespace rondure::cmm::ipp::client
