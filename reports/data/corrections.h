#pragma once

#include <string>
#include <vector>

#include "core/phrase.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// Names what is handed on, in a run directory.
inline constexpr const char* kCorrectionsFile = "corrections.txt";
/// Folder of the tables in a run directory.
inline constexpr const char* kCorrectionsFolder = "corrections";
/// The calibration of a fixture in a run directory.
inline constexpr const char* kCalibrationFile = "fixture-calibration.json";

/// One table for a machine.
struct CorrectionTable {
  std::string kind;  ///< As its head says: "x-of-c"; of a program, "program".
  std::string file;  ///< In the run directory: "corrections/pin-x-of-c.csv".
  std::string text;
};

/// One file that a feature hands on, as reports name it.
struct CorrectionFile {
  std::string kind;
  std::string file;
  record::Format format = record::Format::kCorrections;  ///< That writes it.
};

/// What one feature hands on.
struct FeatureCorrections {
  std::vector<CorrectionFile> files;
  core::Phrase none_because;  ///< Why no table may leave the run; empty where there is one.
};

/// What a run hands on to machines.
struct Corrections {
  /// corrections.txt: for each feature its tables with the predicted gain, or why there is none.
  std::string summary;
  std::vector<CorrectionTable> tables;
  std::vector<FeatureCorrections> of_features;  ///< In the order of the run.
};

/// The feature whose calibration kCalibrationFile holds; null without any.
[[nodiscard]] const evaluation::FeatureResult* calibrated_fixture(
    const evaluation::Evaluation& evaluation);

/// What the analyses of a run give to machines (evaluation/correction): tables of contours, axes
/// and spindles, paths of wheels. A feature that is void, or whose predicted gain is not
/// significant, has none. Takes the trials of one value for each feature.
[[nodiscard]] Corrections write_corrections(const record::RunRecord& record,
                                            const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
