#include "record/journal/internal/schema.h"

#include <algorithm>

namespace rondure::record {
namespace {

/// A table in the form of the versions `since` to `until`.
/// @param columns  The columns after the id, separated by ", ". Each is `not null`, unless it ends
///                 with a question mark.
Table table(std::string_view name, std::string_view columns, std::int64_t since = 1,
            std::int64_t until = kSchemaVersion, std::string_view id_check = "") {
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
  return {name, sql + "\n) strict", since, until};
}

// Measured numbers have the type `any`: a column of type `real` would lose the sign of -0.0,
// because SQLite stores whole numbers there as integers.
const std::vector<Table>& known_tables() {
  static const std::string kTouch =
      "purpose text, pose integer, layer integer, point integer, repeat integer, tip_x_mm any, "
      "tip_y_mm any, tip_z_mm any, approach_x any, approach_y any, approach_z any";
  static const std::string kCharacteristic =
      "feature integer, name text, form text, reference text, tolerance_mm any?, drawing_zone text";
  static const std::vector<Table> kTables = {
      table("header",
            "run_id text, version text, processor text, started_utc text, plan_file text, "
            "plan_name text, plan_revision text, plan_text text, plan_sha256 text, part_id text, "
            "part_name text, drawing text, serial text, operator_name text, machine text, "
            "fixture text, decision_rule text, simulated integer, seed text, "
            "temperature_min_degC any, temperature_max_degC any, ending text not null default '', "
            "failure_code text?, failure_what text?, failure_where text?",
            1, kSchemaVersion, " check (id = 0)"),
      table("artefact",
            "radius_mm any, nominal_tip_radius_mm any, radius_tolerance_mm any, form_limit_mm any",
            1, kSchemaVersion, " check (id = 0)"),
      table("feature",
            "name text, shape text, side text, nominal_diameter_mm any, layers integer, "
            "points_per_layer integer, strategy text, points_file text, points_sha256 text, "
            "tip_radius_mm any?"),
      table("search_step", "feature integer, step_deg any"),
      table("characteristic", kCharacteristic, 1, kFirstIndicationVersion - 1),
      table("characteristic", kCharacteristic + ", lower_mm any?", kFirstIndicationVersion),
      table("characteristic_setting", "characteristic integer, name text, number any?, text text",
            kFirstIndicationVersion),
      table("pose",
            "feature integer, commanded_alpha_rad any, commanded_beta_rad any, "
            "reached_alpha_rad any, reached_beta_rad any, final_cloud integer, time_s any"),
      table("touch", kTouch + ", temperature_degC any, time_s any", 1, 2),
      table("touch", kTouch + ", temperature_degC any, time_s any, scale_temperature_degC any", 3,
            kFirstUnmeasuredVersion - 1),
      table("touch", kTouch + ", temperature_degC any?, time_s any, scale_temperature_degC any?",
            kFirstUnmeasuredVersion),
      table("decision", "feature integer, time_s any, text text", 1, kFirstMessageVersion - 1),
      table("decision", "feature integer, time_s any, code text, arguments text",
            kFirstMessageVersion),
      table("truth", "feature integer, cylt_mm any"),
      table("result", "name text, value any"),
      table("setting", "feature integer, name text, number any?, text text", 3),
      table("harmonic_limit",
            "characteristic integer, first_order integer, last_order integer, amplitude_mm any", 3),
      table("series", "feature integer, name text, role text, row_count integer", 3),
      table("series_column", "series integer, name text, unit text", 3),
      table("series_block", "series integer, first_row integer, row_count integer, rows text", 3),
      table("truth_value", "feature integer, name text, value any", 3),
      table("chain", "table_name text, row_id integer, row_sha256 text, sha256 text",
            kFirstChainedVersion),
      table("seal", "table_name text not null unique, row_count integer, sha256 text")};
  return kTables;
}

}  // namespace

std::vector<Table> chained_tables(std::int64_t version) {
  std::vector<Table> out = tables_of(version);
  std::erase_if(out, [](const Table& one) {
    return one.name == chain_table().name || one.name == seal_table().name;
  });
  return out;
}

std::vector<Table> tables_of(std::int64_t version) {
  std::vector<Table> out;
  for (const Table& one : known_tables()) {
    if (one.since <= version && version <= one.until) out.push_back(one);
  }
  return out;
}

const Table& chain_table() { return known_tables()[known_tables().size() - 2]; }

const Table& seal_table() { return known_tables().back(); }

}  // namespace rondure::record
