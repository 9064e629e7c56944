#pragma once

#include <optional>
#include <string>

#include "core/phrase.h"

namespace rondure::evaluation {

/// A condition that is checked before a value of an analysis is judged. Every report lists all of
/// them, passed or not.
struct Gate {
  enum class Outcome {
    kPassed,
    kWarns,   ///< The values stand, with the reason beside them.
    kBounds,  ///< Some values are only bounds.
    kVoids,   ///< Some values prove nothing.
  };

  std::string code;                  ///< Stable, kebab-case: "first-harmonic".
  core::Phrase condition;            ///< What is compared: "chi2 of the first harmonic".
  std::optional<double> found = {};  ///< None where it could not be computed.
  std::optional<double> limit = {};
  std::string unit = {};  ///< Of both: "um", "deg"; empty of a plain number.
  Outcome outcome = Outcome::kPassed;
  core::Phrase reason = {};  ///< Why it did not pass, in numbers, and what to do; or empty.
};

}  // namespace rondure::evaluation
