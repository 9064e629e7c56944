#include "record/journal/internal/schema.h"

#include <algorithm>
#include <vector>

namespace rondure::record {
namespace {

/// @param columns  The columns after the id, separated by ", ". Each is `not null`, unless it ends
///                 with a question mark.
Table table(std::string_view name, std::string_view columns, std::string_view id_check = "") {
  std::string sql = "create table ";
  sql.append(name).append(" (\n  id integer primary key").append(id_check);
  while (!columns.empty()) {
    const std::size_t end = std::min(columns.find(", "), columns.size());
    std::string column(columns.substr(0, end));
    columns.remove_prefix(std::min(end + 2, columns.size()));
    if (column.ends_with('?')) {
      column.pop_back();
    } else if (column.find(" not null") == std::string::npos) {
      column += " not null";
    }
    sql.append(",\n  ").append(column);
  }
  return {name, sql + "\n) strict"};
}

// Measured numbers have the type `any`: a column of type `real` would lose the sign of -0.0,
// because SQLite stores whole numbers there as integers.
const std::vector<Table>& known_tables() {
  static const std::vector<Table> kTables = {
      table("header",
            "run_id text, version text, processor text, started_utc text, plan_file text, "
            "plan_name text, plan_revision text, plan_text text, plan_sha256 text, part_id text, "
            "part_name text, drawing text, serial text, operator_name text, machine text, "
            "fixture text, decision_rule text, simulated integer, seed text, "
            "temperature_min_degC any, temperature_max_degC any, ending text not null default '', "
            "failure_code text?, failure_what text?, failure_where text?",
            " check (id = 0)"),
      table("artefact",
            "radius_mm any, nominal_tip_radius_mm any, radius_tolerance_mm any, form_limit_mm any",
            " check (id = 0)"),
      table("feature",
            "name text, shape text, side text, nominal_diameter_mm any, layers integer, "
            "points_per_layer integer, strategy text, points_file text, points_sha256 text, "
            "tip_radius_mm any?"),
      table("search_step", "feature integer, step_deg any"),
      table("characteristic",
            "feature integer, name text, form text, reference text, tolerance_mm any?, "
            "drawing_zone text, lower_mm any?"),
      table("characteristic_setting", "characteristic integer, name text, number any?, text text"),
      table("pose",
            "feature integer, commanded_alpha_rad any, commanded_beta_rad any, "
            "reached_alpha_rad any, reached_beta_rad any, final_cloud integer, time_s any"),
      table("touch",
            "purpose text, pose integer, layer integer, point integer, repeat integer, tip_x_mm "
            "any, tip_y_mm any, tip_z_mm any, approach_x any, approach_y any, approach_z any, "
            "temperature_degC any?, time_s any, scale_temperature_degC any?"),
      table("decision", "feature integer, time_s any, code text, arguments text"),
      table("result", "name text, value any"),
      table("setting", "feature integer, name text, number any?, text text"),
      table("harmonic_limit",
            "characteristic integer, first_order integer, last_order integer, amplitude_mm any"),
      table("series", "feature integer, name text, role text, row_count integer"),
      table("series_column", "series integer, name text, unit text"),
      table("series_block", "series integer, first_row integer, row_count integer, rows text"),
      table("truth_value", "feature integer, name text, value any"),
      table("chain", "table_name text, row_id integer, row_sha256 text, sha256 text"),
      table("seal", "table_name text not null unique, row_count integer, sha256 text")};
  return kTables;
}

}  // namespace

std::span<const Table> all_tables() { return known_tables(); }

std::span<const Table> sealed_tables() { return all_tables().first(all_tables().size() - 1); }

std::span<const Table> chained_tables() { return all_tables().first(all_tables().size() - 2); }

const Table& chain_table() { return sealed_tables().back(); }

const Table& seal_table() { return all_tables().back(); }

}  // namespace rondure::record
