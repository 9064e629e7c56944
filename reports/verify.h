#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace rondure::reports {

/// What verifying a run directory found.
struct Verification {
  std::vector<std::string> differences;  ///< In words, place first; empty: everything follows.
  std::string what_was_compared;         ///< One sentence, also says how exactly.
};

/// Recomputes a run from its journal and compares: the digests of the journal's tables, every
/// stored result, and every export that stands in the directory. Changes nothing.
///
/// Bits must be equal on the kind of processor that measured; on another, where the last bit of sin
/// and atan2 differs, numbers may differ by 1e-9 and the sentence says so.
///
/// This finds accidents. Somebody who can write into the directory can also write new digests.
///
/// @param processor  Of this machine, as app spells it in the journal.
/// @return kFile or kJournal when the journal cannot be read.
[[nodiscard]] core::Result<Verification> verify_run(const std::filesystem::path& directory,
                                                    const std::string& processor);

}  // namespace rondure::reports
