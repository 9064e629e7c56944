#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "record/journal/journal.h"
#include "record/run_record.h"
#include "tests/core/scratch.h"

namespace rondure::record {

using test::Scratch;

/// A synthetic run that fills every table; doubles of every size, -0.0, denormals and infinities
/// among them. Same seed, same run.
[[nodiscard]] RunRecord sample_run(std::uint64_t seed, int touches = 50);

/// Writes a run as the program does: head, poses and touches one by one, ending, seal. A run with
/// record.sealed == false is not sealed and ends as if the program had crashed.
[[nodiscard]] core::Result<void> write_run(const std::filesystem::path& directory,
                                           const RunRecord& record);

/// Locks and reads the journal of a run, then opens it for more rows.
[[nodiscard]] core::Result<Journal> reopened(const std::filesystem::path& directory);

/// A touch whose every value follows from its number.
[[nodiscard]] Touch touch_number(std::int64_t id);

/// Every value of a run as text, doubles by their bits: equal exactly when the runs are.
[[nodiscard]] std::string every_bit(const RunRecord& record);

/// every_bit() without the values that differ between runs with equal measurements: name, time of
/// start, decisions about the whole run, checks.
[[nodiscard]] std::string measured_bits(RunRecord record);

}  // namespace rondure::record
