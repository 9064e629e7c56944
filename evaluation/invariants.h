#pragma once

#include <optional>
#include <string>

#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// Round-off allowed where one reported value must not exceed another [mm].
inline constexpr double kInvariantSlack = 1e-9;

/// A relation that holds for any data, but not for a result.
struct BrokenInvariant {
  std::string rule;   ///< "MZCY <= LSCY", "certificate of MICI, layer 2".
  std::string found;  ///< The numbers that violate it, in words.
};

/// Checks the relations between the results of a feature. For the cylinder and every section, MZ is
/// no wider than the deviations about LS, MC and MI; an MC or MI certified as the global optimum is
/// no larger than the outer and no smaller than the inner radius of MZ; no section is wider than
/// the zone of the cylinder; and the witness of every certificate holds, checked by a routine that
/// shares no code with the solvers.
/// @return The first violated relation: a defect of the program, whatever the data.
[[nodiscard]] std::optional<BrokenInvariant> broken_invariant(const FeatureResult& result);

}  // namespace rondure::evaluation
