#pragma once

#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// Names what is handed on, in a run directory.
inline constexpr const char* kCorrectionsFile = "corrections.txt";
/// Folder of the tables in a run directory.
inline constexpr const char* kCorrectionsFolder = "corrections";

/// One table for a machine.
struct CorrectionTable {
  std::string file;  ///< In the run directory: "corrections/pin-x-of-c.csv".
  std::string text;
};

/// What a run hands on to machines.
struct Corrections {
  /// corrections.txt: for each feature its tables with the predicted gain, or why there is none.
  std::string summary;
  std::vector<CorrectionTable> tables;
};

/// What the analyses of a run give to machines (evaluation/correction): tables of contours, axes
/// and spindles, paths of wheels. A feature that is void, or whose predicted gain is not
/// significant, has none. Takes the trials of one value for each feature.
[[nodiscard]] Corrections write_corrections(const record::RunRecord& record,
                                            const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
