#include "record/journal/internal/schema.h"

#include <array>

namespace rondure::record {
namespace {

// Measured numbers have the type `any`: a column of type `real` would lose the sign of -0.0,
// because SQLite packs whole numbers there as integers.
constexpr std::array<Table, 20> kTables = {{
    {"header",
     R"(create table header (
  id integer primary key check (id = 0),
  run_id text not null,
  version text not null,
  processor text not null,
  started_utc text not null,
  plan_file text not null,
  plan_name text not null,
  plan_revision text not null,
  plan_text text not null,
  plan_sha256 text not null,
  part_id text not null,
  part_name text not null,
  drawing text not null,
  serial text not null,
  operator_name text not null,
  machine text not null,
  fixture text not null,
  decision_rule text not null,
  simulated integer not null,
  seed text not null,
  temperature_min_degC any not null,
  temperature_max_degC any not null,
  ending text not null default '',
  failure_code text,
  failure_what text,
  failure_where text
) strict)"},
    {"artefact",
     R"(create table artefact (
  id integer primary key check (id = 0),
  radius_mm any not null,
  nominal_tip_radius_mm any not null,
  radius_tolerance_mm any not null,
  form_limit_mm any not null
) strict)"},
    {"feature",
     R"(create table feature (
  id integer primary key,
  name text not null,
  shape text not null,
  side text not null,
  nominal_diameter_mm any not null,
  layers integer not null,
  points_per_layer integer not null,
  strategy text not null,
  points_file text not null,
  points_sha256 text not null,
  tip_radius_mm any
) strict)"},
    {"search_step",
     R"(create table search_step (
  id integer primary key,
  feature integer not null,
  step_deg any not null
) strict)"},
    {"characteristic",
     R"(create table characteristic (
  id integer primary key,
  feature integer not null,
  name text not null,
  form text not null,
  reference text not null,
  tolerance_mm any,
  drawing_zone text not null
) strict)"},
    {"pose",
     R"(create table pose (
  id integer primary key,
  feature integer not null,
  commanded_alpha_rad any not null,
  commanded_beta_rad any not null,
  reached_alpha_rad any not null,
  reached_beta_rad any not null,
  final_cloud integer not null,
  time_s any not null
) strict)"},
    {"touch",
     R"(create table touch (
  id integer primary key,
  purpose text not null,
  pose integer not null,
  layer integer not null,
  point integer not null,
  repeat integer not null,
  tip_x_mm any not null,
  tip_y_mm any not null,
  tip_z_mm any not null,
  approach_x any not null,
  approach_y any not null,
  approach_z any not null,
  temperature_degC any not null,
  time_s any not null
) strict)",
     1, 2},
    {"touch",
     R"(create table touch (
  id integer primary key,
  purpose text not null,
  pose integer not null,
  layer integer not null,
  point integer not null,
  repeat integer not null,
  tip_x_mm any not null,
  tip_y_mm any not null,
  tip_z_mm any not null,
  approach_x any not null,
  approach_y any not null,
  approach_z any not null,
  temperature_degC any not null,
  time_s any not null,
  scale_temperature_degC any not null
) strict)",
     3, kFirstUnmeasuredVersion - 1},
    {"touch",
     R"(create table touch (
  id integer primary key,
  purpose text not null,
  pose integer not null,
  layer integer not null,
  point integer not null,
  repeat integer not null,
  tip_x_mm any not null,
  tip_y_mm any not null,
  tip_z_mm any not null,
  approach_x any not null,
  approach_y any not null,
  approach_z any not null,
  temperature_degC any,
  time_s any not null,
  scale_temperature_degC any
) strict)",
     kFirstUnmeasuredVersion},
    {"decision",
     R"(create table decision (
  id integer primary key,
  feature integer not null,
  time_s any not null,
  text text not null
) strict)"},
    {"truth",
     R"(create table truth (
  id integer primary key,
  feature integer not null,
  cylt_mm any not null
) strict)"},
    {"result",
     R"(create table result (
  id integer primary key,
  name text not null,
  value any not null
) strict)"},
    {"setting",
     R"(create table setting (
  id integer primary key,
  feature integer not null,
  name text not null,
  number any,
  text text not null
) strict)",
     3},
    {"harmonic_limit",
     R"(create table harmonic_limit (
  id integer primary key,
  characteristic integer not null,
  first_order integer not null,
  last_order integer not null,
  amplitude_mm any not null
) strict)",
     3},
    {"series",
     R"(create table series (
  id integer primary key,
  feature integer not null,
  name text not null,
  role text not null,
  row_count integer not null
) strict)",
     3},
    {"series_column",
     R"(create table series_column (
  id integer primary key,
  series integer not null,
  name text not null,
  unit text not null
) strict)",
     3},
    {"series_block",
     R"(create table series_block (
  id integer primary key,
  series integer not null,
  first_row integer not null,
  row_count integer not null,
  rows text not null
) strict)",
     3},
    {"truth_value",
     R"(create table truth_value (
  id integer primary key,
  feature integer not null,
  name text not null,
  value any not null
) strict)",
     3},
    {"chain",
     R"(create table chain (
  id integer primary key,
  table_name text not null,
  row_id integer not null,
  row_sha256 text not null,
  sha256 text not null
) strict)",
     kFirstChainedVersion},
    {"seal",
     R"(create table seal (
  id integer primary key,
  table_name text not null unique,
  row_count integer not null,
  sha256 text not null
) strict)"},
}};

}  // namespace

std::vector<Table> chained_tables(std::int64_t version) {
  std::vector<Table> out = tables_of(version);
  std::erase_if(out, [](const Table& table) {
    return table.name == chain_table().name || table.name == seal_table().name;
  });
  return out;
}

std::vector<Table> tables_of(std::int64_t version) {
  std::vector<Table> out;
  for (const Table& table : kTables) {
    if (table.since <= version && version <= table.until) out.push_back(table);
  }
  return out;
}

const Table& chain_table() { return kTables[kTables.size() - 2]; }

const Table& seal_table() { return kTables.back(); }

}  // namespace rondure::record
