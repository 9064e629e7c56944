#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::app {

/// The file of a run directory that holds the draws behind its intervals.
inline constexpr const char* kTrialsFile = "trials.bin";

/// Evaluates a run with the draws that its directory keeps, and keeps those that it has to make.
///
/// Draws are taken only where SHA256SUMS names trials.bin with the digest that it has, and the same
/// program drew for the same journal on the same kind of processor: then they are those of this
/// run, bit for bit. `verify` and `sign` never take them.
class KeptTrials {
 public:
  /// Says on the terminal why draws that are there are not taken.
  explicit KeptTrials(std::filesystem::path directory);

  /// evaluation::evaluate_run() of the record in the directory.
  [[nodiscard]] core::Result<evaluation::Evaluation> evaluate(const record::RunRecord& record);

  /// Writes new draws and their line in SHA256SUMS, after the reports of a finished run. A signed
  /// list stays as it is. What cannot be written is said and is no failure: it only saves time.
  void keep() const;

 private:
  std::filesystem::path directory_;
  std::string taken_;  ///< Empty: there were none.
  std::string drawn_;
};

}  // namespace rondure::app
