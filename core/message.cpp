#include "core/message.h"

#include <array>
#include <cassert>
#include <cmath>

namespace rondure::core {
namespace {

using Type = ArgumentKind::Type;

constexpr ArgumentKind text(std::string_view name) { return {name, Type::kText, 0.0}; }
constexpr ArgumentKind words(std::string_view name) { return {name, Type::kWords, 0.0}; }
constexpr ArgumentKind count(std::string_view name) { return {name, Type::kNumber, 0.0}; }
/// Tolerance of a number in a sentence with 3 (um), 4 (deg, mm), 5 or 6 decimals.
constexpr ArgumentKind thousandths(std::string_view name) { return {name, Type::kNumber, 1e-3}; }
constexpr ArgumentKind fourth(std::string_view name) { return {name, Type::kNumber, 1e-4}; }
constexpr ArgumentKind fifth(std::string_view name) { return {name, Type::kNumber, 1e-5}; }
constexpr ArgumentKind sixth(std::string_view name) { return {name, Type::kNumber, 1e-6}; }

constexpr std::array kPartLocated = {fourth("alpha_deg"), fourth("beta_deg"),
                                     fourth("level_alpha_deg"), fourth("level_beta_deg")};
constexpr std::array kLevellingStep = {fourth("alpha_deg"), fourth("beta_deg"),
                                       thousandths("zone_um"), fourth("next_alpha_deg"),
                                       fourth("next_beta_deg")};
constexpr std::array kLevelToResolution = {fourth("alpha_deg"), fourth("beta_deg"),
                                           thousandths("zone_um"), sixth("step_deg"),
                                           sixth("resolution_deg")};
constexpr std::array kLevelToScatter = {fourth("alpha_deg"), fourth("beta_deg"),
                                        thousandths("zone_um"), sixth("step_deg")};
constexpr std::array kLevelPoseBeyondLimits = {fourth("alpha_deg"), fourth("beta_deg"),
                                               thousandths("zone_um"), fourth("level_alpha_deg"),
                                               fourth("level_beta_deg")};
constexpr std::array kLevelPoseUnreachable = {words("reason")};
constexpr std::array kNotLevelAfterPoses = {fourth("alpha_deg"), fourth("beta_deg"),
                                            thousandths("zone_um"), count("poses"),
                                            fourth("step_deg")};
constexpr std::array kPoseSearchEnded = {fourth("alpha_deg"), fourth("beta_deg"), count("poses"),
                                         thousandths("f_um")};
constexpr std::array kTargetsReachable = {fourth("alpha_deg"), fourth("beta_deg"),
                                          count("reachable"), count("targets")};
constexpr std::array kFixtureBaseFound = {fourth("shift_x_mm"),
                                          fourth("shift_y_mm"),
                                          fourth("shift_z_mm"),
                                          fifth("turn_x_deg"),
                                          fifth("turn_y_deg"),
                                          fifth("turn_z_deg"),
                                          thousandths("largest_residual_um")};
constexpr std::array kSingleSteps = {count("travel_speed_mm_s")};
constexpr std::array kRunResumed = {text("resumed_utc"), count("touches"), count("repeated"),
                                    thousandths("largest_difference_um"), count("limit_um")};
constexpr std::array kPartLocatedAgain = {count("touches"), words("reason")};
constexpr std::array kClampingChanged = {count("touches"), text("clamped"), words("answered_utc")};
constexpr std::array kCalibrationTaken = {text("calibration"), words("void_because")};
constexpr std::array kCorrectionLoaded = {words("answered_utc"), words("sha256")};

/// The only list of codes, with their names and arguments.
struct Entry {
  MessageCode code;
  std::string_view name;
  std::span<const ArgumentKind> arguments;
};

constexpr std::array kMessages = {
    Entry{MessageCode::kPartLocated, "part-located", kPartLocated},
    Entry{MessageCode::kLevellingStep, "levelling-step", kLevellingStep},
    Entry{MessageCode::kLevelToResolution, "level-to-resolution", kLevelToResolution},
    Entry{MessageCode::kLevelToScatter, "level-to-scatter", kLevelToScatter},
    Entry{MessageCode::kLevelPoseBeyondLimits, "level-pose-beyond-limits", kLevelPoseBeyondLimits},
    Entry{MessageCode::kLevelPoseUnreachable, "level-pose-unreachable", kLevelPoseUnreachable},
    Entry{MessageCode::kNotLevelAfterPoses, "not-level-after-poses", kNotLevelAfterPoses},
    Entry{MessageCode::kPoseSearchEnded, "pose-search-ended", kPoseSearchEnded},
    Entry{MessageCode::kTargetsReachable, "targets-reachable", kTargetsReachable},
    Entry{MessageCode::kFixtureBaseFound, "fixture-base-found", kFixtureBaseFound},
    Entry{MessageCode::kSingleSteps, "single-steps", kSingleSteps},
    Entry{MessageCode::kRunResumed, "run-resumed", kRunResumed},
    Entry{MessageCode::kPartLocatedAgain, "part-located-again", kPartLocatedAgain},
    Entry{MessageCode::kClampingChanged, "clamping-changed", kClampingChanged},
    Entry{MessageCode::kCalibrationTaken, "calibration-taken", kCalibrationTaken},
    Entry{MessageCode::kCorrectionLoaded, "correction-loaded", kCorrectionLoaded},
};

constexpr bool stand_in_order() {
  for (std::size_t i = 0; i < kMessages.size(); ++i) {
    if (kMessages[i].code != static_cast<MessageCode>(i)) return false;
  }
  return kMessages.back().code == kLastMessageCode;
}
static_assert(stand_in_order());

const Entry& entry_of(MessageCode code) { return kMessages.at(static_cast<std::size_t>(code)); }

bool says_the_same(const ArgumentKind& kind, const Argument& a, const Argument& b) {
  if (kind.type == Type::kWords) return true;
  if (kind.type == Type::kText) return a == b;
  const double x = std::get<double>(a);
  const double y = std::get<double>(b);
  return x == y || std::abs(x - y) <= kind.same_within;  // the first part is for infinite numbers
}

}  // namespace

std::string_view message_name(MessageCode code) { return entry_of(code).name; }

std::span<const ArgumentKind> arguments_of(MessageCode code) { return entry_of(code).arguments; }

std::optional<MessageCode> message_named(std::string_view name) {
  for (const Entry& entry : kMessages) {
    if (entry.name == name) return entry.code;
  }
  return std::nullopt;
}

bool say_the_same(const Message& a, const Message& b) {
  if (a.code != b.code || a.arguments.size() != b.arguments.size()) return false;
  const auto kinds = arguments_of(a.code);
  assert(kinds.size() == a.arguments.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!says_the_same(kinds[i], a.arguments[i], b.arguments[i])) return false;
  }
  return true;
}

}  // namespace rondure::core
