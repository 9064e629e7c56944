#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace rondure::core {

/// The codes of messages that are not errors (those have a Code): decisions of the program during a
/// run. JSON spells them in kebab case (message_name()); reports/words/internal/messages.h makes
/// their sentences.
enum class MessageCode {
  kPartLocated,            ///< part-located: the axis of the part and its level pose were found
  kLevellingStep,          ///< levelling-step: the guided search turns to another pose
  kLevelToResolution,      ///< level-to-resolution: the fixture cannot level the part any better
  kLevelToScatter,         ///< level-to-scatter: another step would follow noise
  kLevelPoseBeyondLimits,  ///< level-pose-beyond-limits: the fixture cannot turn there
  kLevelPoseUnreachable,   ///< level-pose-unreachable: the probe cannot measure there
  kNotLevelAfterPoses,     ///< not-level-after-poses: max_poses ended the search
  kPoseSearchEnded,        ///< pose-search-ended: the grid search chose its best pose
  kTargetsReachable,       ///< targets-reachable: in a pose of a merged cloud
  kFixtureBaseFound,       ///< fixture-base-found: from its reference spheres
  kSingleSteps,            ///< single-steps: an operator confirms each move
  kRunResumed,             ///< run-resumed: the last touches were repeated
  kPartLocatedAgain,       ///< part-located-again: the part had moved while the run was interrupted
  kClampingChanged,        ///< clamping-changed: balls and part were exchanged in the fixture
  kCalibrationTaken,       ///< calibration-taken: what later features take of the fixture's errors
  kCorrectionLoaded,       ///< correction-loaded: what follows was measured with it in the control
};
/// The last code of the list.
inline constexpr MessageCode kLastMessageCode = MessageCode::kCorrectionLoaded;

/// Declares one argument of a code.
struct ArgumentKind {
  enum class Type {
    kNumber,
    kText,  ///< Compared character by character.
    /// A sentence from another part of the program or from a machine: shown, never compared.
    kWords,
  };
  std::string_view name;  ///< Name in JSON; for a number, with its unit: "zone_um".
  Type type = Type::kNumber;
  /// Two numbers count as equal when they differ by no more: one unit of the last digit in the
  /// sentence.
  double same_within = 0.0;
};

/// A number, finite or infinite, or a text.
using Argument = std::variant<double, std::string>;

/// A message as data: it becomes a sentence where a person reads it, in the reader's language.
struct Message {
  MessageCode code = MessageCode::kPartLocated;
  std::vector<Argument> arguments;  ///< As arguments_of() declares them.

  [[nodiscard]] double number(std::size_t i) const { return std::get<double>(arguments.at(i)); }
  [[nodiscard]] const std::string& text(std::size_t i) const {
    return std::get<std::string>(arguments.at(i));
  }

  friend bool operator==(const Message&, const Message&) = default;
};

/// The name of a code in JSON and in the journal, e.g. "part-located".
[[nodiscard]] std::string_view message_name(MessageCode code);

/// The code of a name, or nothing.
[[nodiscard]] std::optional<MessageCode> message_named(std::string_view name);

/// The arguments of a code, in their order.
[[nodiscard]] std::span<const ArgumentKind> arguments_of(MessageCode code);

/// Whether two messages are equal: same code, equal texts, numbers within same_within.
[[nodiscard]] bool say_the_same(const Message& a, const Message& b);

}  // namespace rondure::core
