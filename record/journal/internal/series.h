#pragma once

#include <span>

#include <soci/soci.h>

#include "record/journal/internal/chain.h"
#include "record/run_record.h"

// Private to the room: converts series, settings and harmonic limits to rows and back. All
// functions throw: soci::soci_error, std::runtime_error for an invalid series, Contradiction when
// reading.

namespace rondure::record {

/// Rows of a series in one row of table series_block.
inline constexpr std::size_t kBlockRows = 256;

/// Stands for the feature index in a setting of the whole run.
inline constexpr int kWholeRun = -1;

/// Writes the settings of a feature, or of the whole run.
void insert_settings(soci::session& sql, int feature, std::span<const Setting> settings);
/// Writes the indication and the mask of the characteristic whose row was inserted last.
void insert_keys_of_characteristic(soci::session& sql, const Characteristic& characteristic);

/// Writes series and numbers of hidden truth, and links their rows.
void insert_series(soci::session& sql, Chain& chain, std::span<const Series> series,
                   std::span<const TruthValue> truths);

/// Reads these tables into a record that has its features.
void read_series_tables(soci::session& sql, RunRecord& record);

}  // namespace rondure::record
