#pragma once

#include <span>
#include <string>

#include <soci/soci.h>

#include "record/journal/internal/chain.h"
#include "record/journal/internal/values.h"
#include "record/run_record.h"

// Private to the room: writes records as rows. All functions throw soci::soci_error.

namespace rondure::record {

/// The statements that run during a measurement: prepared once, bound to the members beside them.
struct Statements {
  Touch touch;
  std::string purpose;
  Measured temperature_degC;
  Measured scale_temperature_degC;
  PoseVisit pose;
  int final_cloud = 0;
  Decision decision;
  std::string decision_code;
  std::string decision_arguments;
  int marked_pose = 0;
  soci::statement insert_touch;
  soci::statement insert_pose;
  soci::statement insert_decision;
  soci::statement update_final;

  explicit Statements(soci::session& sql);
  Statements(const Statements&) = delete;
  Statements& operator=(const Statements&) = delete;
};

/// Creates the tables, fills those that are known before the first touch and links their rows, in
/// one transaction.
void insert_head(soci::session& sql, const Header& header, const Artefact& artefact,
                 std::span<const Feature> features, std::span<const Setting> settings);

/// Writes the results and links them.
void insert_results(soci::session& sql, Chain& chain, std::span<const StoredResult> results);

}  // namespace rondure::record
