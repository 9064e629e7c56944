#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/verify/verify.h"

namespace rondure::app {

/// Model and vector units of this processor; results are bit-identical on the same kind only.
[[nodiscard]] std::string processor();

/// The current time as ISO 8601 in UTC: "2026-11-21T02:33:02Z".
[[nodiscard]] std::string utc_now();

/// Evaluates a run with the draws that its directory keeps, and keeps those that it has to make.
///
/// Draws are taken only where SHA256SUMS names trials.bin with the digest that it has, the same
/// program drew for the same journal on the same kind of processor, and they give the results that
/// stand under the seal of the journal. `verify` and `sign` never take them.
class KeptTrials {
 public:
  /// Says on the terminal why draws that are there are not taken.
  explicit KeptTrials(std::filesystem::path directory);

  /// evaluation::evaluate_checked() of the record in the directory. Draws again, and says so, where
  /// those that were kept do not give the sealed results.
  [[nodiscard]] core::Result<evaluation::Evaluation> evaluate(const record::RunRecord& record);

  /// Writes new draws and their line in SHA256SUMS, after the reports of a finished run. A signed
  /// list stays as it is. What cannot be written is said and is no failure: it only saves time.
  void keep() const;

 private:
  void tell_drawn_again(const std::string& why) const;

  std::filesystem::path directory_;
  std::string taken_;  ///< Empty: there were none.
  std::string drawn_;
};

/// How `verify` and `sign` compare a run directory.
[[nodiscard]] reports::VerifyOptions verify_options(const std::filesystem::path& directory);

}  // namespace rondure::app
