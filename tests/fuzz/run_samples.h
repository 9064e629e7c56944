#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rondure::fuzz {

/// Finished runs of the example plans with fewer touches, made once by the program: one of each
/// kind of feature.
[[nodiscard]] const std::vector<std::filesystem::path>& sample_runs();

/// The one of the first example, made alone.
[[nodiscard]] const std::filesystem::path& spool_run();

/// Damages the rows of a copy of one of them, and computes chain, seal and SHA256SUMS anew, so that
/// the journal passes the checks. The same seed makes the same journal.
/// @param directory  Emptied first.
void write_resealed_run(const std::filesystem::path& directory, unsigned seed);

}  // namespace rondure::fuzz
