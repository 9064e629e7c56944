#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "core/error.h"
#include "core/result.h"
#include "reports/evaluation.h"
#include "reports/invariants.h"

namespace rondure::reports {

/// A result that breaks an invariant: a defect of the program. It is never printed as a value.
struct Defect {
  BrokenInvariant broken;
  FeatureResult result;  ///< With everything that was computed of it.
};

/// evaluate(), with the defect whole.
[[nodiscard]] tl::expected<Evaluation, Defect> evaluate_or_defect(const record::RunRecord& record);

/// The defect in one sentence, kInternal at the feature.
/// @param evidence  What to send with a report of it.
[[nodiscard]] core::Error error_of(const Defect& defect, const std::string& evidence);

/// Text to attach to a bug report: versions, processor, feature, rule, every fit and every point
/// with 17 digits [mm].
[[nodiscard]] std::string dump_of(const Defect& defect, const record::Header& header,
                                  const std::string& processor);

inline constexpr const char* kDefectFile = "defect.txt";

/// Writes the dump into `directory` as defect.txt. The error names the file, or the journal where
/// the file cannot be written.
[[nodiscard]] core::Error keep_defect(const Defect& defect, const record::Header& header,
                                      const std::filesystem::path& directory,
                                      const std::string& processor);

/// evaluate() for a run directory, where a defect leaves its defect.txt.
/// @param processor  Of this machine, as app spells it in the journal.
[[nodiscard]] core::Result<Evaluation> evaluate_run(const record::RunRecord& record,
                                                    const std::filesystem::path& directory,
                                                    const std::string& processor);

}  // namespace rondure::reports
