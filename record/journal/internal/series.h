#pragma once

#include <cstdint>
#include <span>

#include <soci/soci.h>

#include "record/journal/internal/chain.h"
#include "record/run_record.h"

// Private to the room: series, settings and harmonic limits as rows and back. Everything here
// throws: soci::soci_error, std::runtime_error for a series that is none, Contradiction in reading.

namespace rondure::record {

/// Rows of a series in one row of table series_block.
inline constexpr std::size_t kBlockRows = 256;

/// What stands in place of a feature where a setting is one of the whole run.
inline constexpr int kWholeRun = -1;

/// Writes the settings of a feature, or of the whole run.
void insert_settings(soci::session& sql, int feature, std::span<const Setting> settings);
/// Writes the mask of the characteristic that was inserted last.
void insert_harmonic_limits(soci::session& sql, std::span<const HarmonicLimit> limits);

/// Writes series and numbers of hidden truth, and links their rows.
void insert_series(soci::session& sql, Chain& chain, std::span<const Series> series,
                   std::span<const TruthValue> truths);

/// Reads all of that into a record that has its features. Nothing of it is there before
/// version 3, no setting of the whole run before version 4.
void read_series_tables(soci::session& sql, RunRecord& record, std::int64_t version);

}  // namespace rondure::record
