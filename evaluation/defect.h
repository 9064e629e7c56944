#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "evaluation/invariants.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// A result that breaks an invariant: a defect of the program. It is never printed as a value.
struct Defect {
  BrokenInvariant broken;
  FeatureResult result;  ///< With everything that was computed of it.
};

/// An evaluation, and the results that were taken out of it.
struct CheckedEvaluation {
  Evaluation evaluation;
  std::vector<Defect> defects;
};

/// What every result must pass: the first relation that it breaks, or nothing.
using InvariantCheck = std::function<std::optional<BrokenInvariant>(const FeatureResult&)>;

/// evaluate(), with the defects whole. A feature that does not pass keeps no fit and no value: its
/// failure is error_of(), its characteristics are void with that reason. The other features stay.
/// @param check  In place of broken_invariant(): no data break an invariant, tests do.
[[nodiscard]] CheckedEvaluation evaluate_checked(const record::RunRecord& record,
                                                 const InvariantCheck& check = broken_invariant);

/// The defect in one sentence, kInternal at the feature: the same wherever the run is evaluated.
[[nodiscard]] core::Error error_of(const Defect& defect);

/// Text to attach to a bug report: versions, processor, feature, rule, every fit and every point
/// with 17 digits [mm].
[[nodiscard]] std::string dump_of(const Defect& defect, const record::Header& header,
                                  const std::string& processor);

inline constexpr const char* kDefectFile = "defect.txt";

/// Writes the dumps into `directory` as defect.txt; without a defect nothing.
/// @return kInternal where the file cannot be written: the first defect, and the journal as the
///         evidence that is left.
[[nodiscard]] core::Result<void> keep_defects(const std::vector<Defect>& defects,
                                              const record::Header& header,
                                              const std::filesystem::path& directory,
                                              const std::string& processor);

/// evaluate() for a run directory, where defects leave their defect.txt.
/// @param processor  Of this machine, as app spells it in the journal.
/// @return keep_defects()'s error.
[[nodiscard]] core::Result<Evaluation> evaluate_run(const record::RunRecord& record,
                                                    const std::filesystem::path& directory,
                                                    const std::string& processor);

}  // namespace rondure::evaluation
