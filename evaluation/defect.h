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

/// A result that violates an invariant, which is a defect of the program. It is never printed as a
/// value.
struct Defect {
  BrokenInvariant broken;
  FeatureResult result;  ///< Everything that was computed for the feature.
};

/// An evaluation, and the results that were removed from it.
struct CheckedEvaluation {
  Evaluation evaluation;
  std::vector<Defect> defects;
};

/// A check that every result must pass: returns the first relation that it violates, or nothing.
using InvariantCheck = std::function<std::optional<BrokenInvariant>(const FeatureResult&)>;

/// Like evaluate(), and keeps the defects whole. A feature that fails the check keeps no fit and no
/// value: its failure is error_of(), its characteristics are void with that reason. The other
/// features stay.
/// @param check  Replaces broken_invariant() in tests, since no data violate an invariant.
[[nodiscard]] CheckedEvaluation evaluate_checked(const record::RunRecord& record,
                                                 const InvariantCheck& check = broken_invariant);

/// The defect in one sentence, kInternal at the feature: identical wherever the run is evaluated.
[[nodiscard]] core::Error error_of(const Defect& defect);

/// Text to attach to a bug report: versions, processor, feature, rule, every fit and every point
/// with 17 digits [mm].
[[nodiscard]] std::string dump_of(const Defect& defect, const record::Header& header,
                                  const std::string& processor);

inline constexpr const char* kDefectFile = "defect.txt";

/// Writes the dumps into `directory` as defect.txt; without a defect nothing is written.
/// @return kInternal where the file cannot be written: it names the first defect, and the journal
///         as the remaining evidence.
[[nodiscard]] core::Result<void> keep_defects(const std::vector<Defect>& defects,
                                              const record::Header& header,
                                              const std::filesystem::path& directory,
                                              const std::string& processor);

}  // namespace rondure::evaluation
