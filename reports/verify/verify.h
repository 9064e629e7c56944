#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/journal/journal.h"

namespace rondure::reports {

/// Settings of verify_run().
struct VerifyOptions {
  std::string processor;  ///< Processor of this machine, spelled as in the journal.
  std::optional<std::string> public_key_pem;  ///< If given, the signature is checked too.
  /// Whether a record can be evaluated: plans::check_record(), which this room does not see.
  std::function<core::Result<void>(const record::ReadJournal&)> check = {};
  /// What this program would write before the draws in trials.bin of this directory.
  std::string trials_head = {};
};

/// Result of verify_run().
struct Verification {
  /// Differences in words, place first; empty: everything agrees.
  std::vector<std::string> differences;
  std::string what_was_compared;  ///< Part, serial, verdict, and how exactly, in one sentence.
  /// Limits of the comparison that are no differences, one sentence each: another version, no list.
  std::vector<std::string> notes;
};

/// Recomputes a run from its journal and compares: the chain over the journal's rows, the digests
/// of its tables, the SHA-256 of the files (SHA256SUMS), every stored result, and every export in
/// the directory. Draws the intervals for itself, and compares the kept draws too: they may be
/// missing, not altered. Changes nothing, and does not evaluate a journal that was changed after it
/// was written.
///
/// Bits must be equal for the version and the kind of processor that measured. On another
/// processor, where the last bit of sin and atan2 differs, and when another version measured,
/// numbers that both give are compared within 1e-9, and only SHA256SUMS covers the wording of
/// reports. `what_was_compared` states which comparison was made.
///
/// Without a key this finds accidents: anybody who can write into the directory can also write new
/// digests. With a key it finds forgery, too: a file that the list names must then exist, and a
/// file that is read must be on the list.
///
/// @return kFile or kJournal when the journal or an export cannot be read or is a link, kBadOption
/// for a key of another kind.
[[nodiscard]] core::Result<Verification> verify_run(const std::filesystem::path& directory,
                                                    const VerifyOptions& options);

/// Whether an evaluation gives the results that stand under the seal of a run, as exactly as
/// verify_run() asks. False for a run without a seal.
[[nodiscard]] bool gives_stored_results(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation,
                                        const std::string& processor);

}  // namespace rondure::reports
