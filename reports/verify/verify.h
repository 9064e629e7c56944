#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::reports {

/// Settings of verify_run().
struct VerifyOptions {
  std::string processor;                      ///< Of this machine, spelled as in the journal.
  std::optional<std::string> public_key_pem;  ///< Checks the signature too, when given.
  /// Whether a record can be evaluated: plans::check_record(), which this room does not see.
  std::function<core::Result<void>(const record::RunRecord&)> check = {};
};

/// Result of verify_run().
struct Verification {
  std::vector<std::string> differences;  ///< In words, place first; empty: everything follows.
  std::string what_was_compared;         ///< One sentence: part, serial, verdict, and how exactly.
  /// Limits of the answer that are no differences, one sentence each: another version, no list.
  std::vector<std::string> notes;
};

/// Recomputes a run from its journal and compares: the chain over the journal's rows, the digests
/// of its tables, the SHA-256 of the files (SHA256SUMS), every stored result, and every export that
/// stands in the directory. Changes nothing, and evaluates no journal that is not as it was
/// written.
///
/// Bits must be equal for the version and the kind of processor that measured. On another
/// processor, where the last bit of sin and atan2 differs, numbers may differ by 1e-9. When another
/// version measured, numbers that both versions give are compared within 1e-9, and the wording of
/// reports is left to SHA256SUMS. The sentence says which.
///
/// Without a key this finds accidents: somebody who can write into the directory can also write new
/// digests. With a key it finds forgery, too: then a file that the list names must be there, and
/// one that is read must be on the list.
///
/// @return kFile or kJournal when the journal or an export cannot be read, kBadOption for a key of
/// another kind.
[[nodiscard]] core::Result<Verification> verify_run(const std::filesystem::path& directory,
                                                    const VerifyOptions& options);

}  // namespace rondure::reports
