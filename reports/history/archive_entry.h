#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/archive/archive.h"

namespace rondure::reports {

/// A finished run for the archive: one result for each characteristic. Texts are made well-formed
/// UTF-8 without NUL, which every database accepts.
///
/// @param journal_sha256  SHA-256 of the sealed journal.
[[nodiscard]] record::ArchiveRun archive_entry(const record::RunRecord& record,
                                               const evaluation::Evaluation& evaluation,
                                               std::string journal_sha256);

}  // namespace rondure::reports
