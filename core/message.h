#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace rondure::core {

/// The codes of messages that are no errors (those: Code): what the program decided during a run.
/// JSON spells them in kebab case (message_name()); their sentences are made in
/// reports/words/internal/messages.h.
enum class MessageCode {
  kSentence,               ///< sentence: of an old journal, in words that no code stands for
  kPartLocated,            ///< part-located: its axis was found, and where it is level
  kLevellingStep,          ///< levelling-step: the guided search turns to another pose
  kLevelToResolution,      ///< level-to-resolution: the fixture cannot be set more level
  kLevelToScatter,         ///< level-to-scatter: another step would follow noise
  kLevelPoseBeyondLimits,  ///< level-pose-beyond-limits: the fixture cannot turn there
  kLevelPoseUnreachable,   ///< level-pose-unreachable: the probe cannot measure there
  kNotLevelAfterPoses,     ///< not-level-after-poses: max_poses ended the search
  kPoseSearchEnded,        ///< pose-search-ended: the grid search chose its best pose
  kTargetsReachable,       ///< targets-reachable: of a pose of a merged cloud
  kFixtureBaseFound,       ///< fixture-base-found: from its reference spheres
  kSingleSteps,            ///< single-steps: an operator confirms each move
  kRunResumed,             ///< run-resumed: the last touches were repeated
  kPartLocatedAgain,       ///< part-located-again: it had moved while the run was interrupted
};
/// The last of them.
inline constexpr MessageCode kLastMessageCode = MessageCode::kPartLocatedAgain;

/// Declares one argument of a code.
struct ArgumentKind {
  enum class Type {
    kNumber,
    kText,   ///< Compared letter by letter.
    kWords,  ///< A sentence of another part of the program or of a machine: shown, never compared.
  };
  std::string_view name;  ///< As JSON spells it; of a number with its unit: "zone_um".
  Type type = Type::kNumber;
  /// Two numbers are the same when they differ by no more: one unit of the last digit that the
  /// sentence shows, so that a number read from an old sentence is that which was rounded into it.
  double same_within = 0.0;
};

/// A number, finite or infinite, or a text.
using Argument = std::variant<double, std::string>;

/// A message as data: its sentence is made where a person reads it, in the language of the reader.
struct Message {
  MessageCode code = MessageCode::kSentence;
  std::vector<Argument> arguments;  ///< As arguments_of() declares them.

  [[nodiscard]] double number(std::size_t i) const { return std::get<double>(arguments.at(i)); }
  [[nodiscard]] const std::string& text(std::size_t i) const {
    return std::get<std::string>(arguments.at(i));
  }

  friend bool operator==(const Message&, const Message&) = default;
};

/// The name of a code as JSON and the journal spell it, e.g. "part-located".
[[nodiscard]] std::string_view message_name(MessageCode code);

/// The code of a name, or nothing.
[[nodiscard]] std::optional<MessageCode> message_named(std::string_view name);

/// The arguments of a code, in their order.
[[nodiscard]] std::span<const ArgumentKind> arguments_of(MessageCode code);

/// Whether two messages say the same: one code, texts alike, numbers within same_within.
[[nodiscard]] bool say_the_same(const Message& a, const Message& b);

}  // namespace rondure::core
