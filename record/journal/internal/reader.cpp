#include "record/journal/internal/reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/csv/internal/lines.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/rows.h"
#include "record/journal/internal/schema.h"
#include "record/journal/internal/series.h"
#include "record/journal/message_text.h"

namespace rondure::record {
namespace {

using soci::into;

template <class Number>
Number single(soci::session& sql, const std::string& query) {
  Number number{};
  sql << query, into(number);
  return number;
}

/// Throws unless the file is a journal with the tables of this program.
void require_journal(soci::session& sql) {
  const auto application = single<long long>(sql, "pragma application_id");
  if (application != kApplicationId) {
    throw Contradiction(
        fmt::format("it is no journal of Rondure (application_id {:#x}, expected "
                    "{:#x})",
                    application, kApplicationId));
  }
  const auto version = single<long long>(sql, "pragma user_version");
  if (version != kSchemaVersion) {
    const bool earlier = version > 0 && version < kSchemaVersion;
    throw Contradiction(
        fmt::format("its tables have version {}, this program reads version {} alone, signed or "
                    "not; {}",
                    version, kSchemaVersion,
                    earlier ? "Rondure 0.1.0 reads versions 1 to 4, commit eac6925f of Rondure "
                              "0.2.0 versions 1 to 7"
                            : "read it with the program that wrote it"));
  }
  require_schema(sql);
  const auto verdict = single<std::string>(sql, "pragma integrity_check(1)");
  if (verdict != "ok") throw Damage("it is damaged: " + verdict);
}

core::Code code_named(const std::string& text) {
  for (int i = 0; i <= static_cast<int>(core::kLastCode); ++i) {
    if (core::code_name(static_cast<core::Code>(i)) == text) return static_cast<core::Code>(i);
  }
  throw Contradiction(fmt::format("header.failure_code is the unknown \"{}\"", text.substr(0, 40)));
}

std::uint64_t seed_from(const std::string& text) {
  std::uint64_t seed = 0;  // unchanged for a text that is not a number
  (void)std::from_chars(text.data(), text.data() + text.size(), seed);
  if (std::to_string(seed) != text) {
    throw Contradiction(fmt::format("header.seed is \"{}\", no whole number", text.substr(0, 40)));
  }
  return seed;
}

void read_header(soci::session& sql, RunRecord& record) {
  Header& h = record.header;
  int simulated = 0;
  std::string seed;
  std::array<std::string, 3> failure;
  soci::indicator failed = soci::i_null;
  sql << "select run_id, version, processor, started_utc, plan_file, plan_name, plan_revision, "
         "plan_text, plan_sha256, part_id, part_name, drawing, serial, operator_name, machine, "
         "fixture, decision_rule, simulated, seed, temperature_min_degC, temperature_max_degC, "
         "ending, failure_code, coalesce(failure_what, ''), coalesce(failure_where, '') from "
         "header",
      into(h.run_id), into(h.version), into(h.processor), into(h.started_utc), into(h.plan_file),
      into(h.plan_name), into(h.plan_revision), into(h.plan_text), into(h.plan_sha256),
      into(h.part_id), into(h.part_name), into(h.drawing), into(h.serial), into(h.operator_name),
      into(h.machine), into(h.fixture), into(h.decision_rule), into(simulated), into(seed),
      into(h.temperature_min_degC), into(h.temperature_max_degC), into(record.ending),
      into(failure[0], failed), into(failure[1]), into(failure[2]);
  if (!sql.got_data()) throw Contradiction("its table header is empty");
  require_numbers("header.temperature_degC", {h.temperature_min_degC, h.temperature_max_degC});
  h.simulated = simulated != 0;
  h.seed = seed_from(seed);
  if (failed == soci::i_ok) {
    record.failure = core::Error{code_named(failure[0]), failure[1], failure[2]};
  }
}

void read_artefact(soci::session& sql, RunRecord& record) {
  Artefact& artefact = record.artefact;
  sql << "select radius_mm, nominal_tip_radius_mm, radius_tolerance_mm, form_limit_mm from "
         "artefact",
      into(artefact.radius_mm), into(artefact.nominal_tip_radius_mm),
      into(artefact.radius_tolerance_mm), into(artefact.form_limit_mm);
  if (!sql.got_data()) throw Contradiction("its table artefact is empty");
  require_numbers("artefact", {artefact.radius_mm, artefact.nominal_tip_radius_mm,
                               artefact.radius_tolerance_mm, artefact.form_limit_mm});
}

void read_features(soci::session& sql, RunRecord& record) {
  Feature row;
  std::string shape;
  std::string side;
  std::string strategy;
  Measured tip_radius_mm;
  std::int64_t id = 0;
  soci::statement rows =
      (sql.prepare
           << "select id, name, shape, side, nominal_diameter_mm, layers, points_per_layer, "
              "strategy, points_file, points_sha256, tip_radius_mm from feature order by id",
       into(id), into(row.id), into(shape), into(side), into(row.nominal_diameter_mm),
       into(row.layers), into(row.points_per_layer), into(strategy), into(row.points_file),
       into(row.points_sha256), into(tip_radius_mm.value, tip_radius_mm.given));
  rows.execute();
  while (rows.fetch()) {
    if (id != static_cast<std::int64_t>(record.features.size())) {
      throw Contradiction(fmt::format("feature {} is missing", record.features.size()));
    }
    row.shape = named<Shape>("feature.shape", shape);
    row.side = named<Side>("feature.side", side);
    row.strategy = named<Strategy>("feature.strategy", strategy);
    row.tip_radius_mm = tip_radius_mm.get();
    require_number("feature.nominal_diameter_mm", row.nominal_diameter_mm);
    require_number("feature.tip_radius_mm", row.tip_radius_mm.value_or(0.0));
    record.features.push_back(row);
  }
}

void read_search_steps(soci::session& sql, RunRecord& record) {
  int feature = 0;
  double step_deg = 0.0;
  soci::statement rows = (sql.prepare << "select feature, step_deg from search_step order by id",
                          into(feature), into(step_deg));
  rows.execute();
  while (rows.fetch()) {
    Feature& owner = feature_at(record, feature, "search_step");
    require_number("search_step.step_deg", step_deg);
    owner.search_steps_deg.push_back(step_deg);
  }
}

void read_characteristics(soci::session& sql, RunRecord& record) {
  Characteristic row;
  int feature = 0;
  std::string form;
  std::string reference;
  Measured tolerance_mm;
  Measured lower_mm;
  soci::statement rows =
      (sql.prepare << "select feature, name, form, reference, tolerance_mm, drawing_zone, lower_mm "
                      "from characteristic order by id",
       into(feature), into(row.id), into(form), into(reference),
       into(tolerance_mm.value, tolerance_mm.given), into(row.drawing_zone),
       into(lower_mm.value, lower_mm.given));
  rows.execute();
  while (rows.fetch()) {
    Feature& owner = feature_at(record, feature, "characteristic");
    row.form = named<Form>("characteristic.form", form);
    row.reference = named<Reference>("characteristic.reference", reference);
    row.tolerance_mm = tolerance_mm.get();
    row.lower_mm = lower_mm.get();
    require_number("characteristic.tolerance_mm", row.tolerance_mm.value_or(0.0));
    require_number("characteristic.lower_mm", row.lower_mm.value_or(0.0));
    owner.characteristics.push_back(row);
  }
}

void read_poses(soci::session& sql, RunRecord& record) {
  PoseVisit row;
  int final_cloud = 0;
  soci::statement rows =
      (sql.prepare << "select id, feature, commanded_alpha_rad, commanded_beta_rad, "
                      "reached_alpha_rad, reached_beta_rad, final_cloud, time_s from pose "
                      "order by id",
       into(row.id), into(row.feature), into(row.commanded.alpha_rad), into(row.commanded.beta_rad),
       into(row.reached.alpha_rad), into(row.reached.beta_rad), into(final_cloud),
       into(row.time_s));
  rows.execute();
  while (rows.fetch()) {
    (void)feature_at(record, row.feature, "pose");
    require_numbers("pose", {row.commanded.alpha_rad, row.commanded.beta_rad, row.reached.alpha_rad,
                             row.reached.beta_rad, row.time_s});
    row.final_cloud = final_cloud != 0;
    record.poses.push_back(row);
  }
}

void read_touches(soci::session& sql, RunRecord& record) {
  Touch row;
  std::string purpose;
  Measured temperature;
  Measured scales;
  soci::statement rows =
      (sql.prepare << "select id, purpose, pose, layer, point, repeat, tip_x_mm, tip_y_mm, "
                      "tip_z_mm, approach_x, approach_y, approach_z, temperature_degC, time_s, "
                      "scale_temperature_degC from touch order by id",
       into(row.id), into(purpose), into(row.pose), into(row.layer), into(row.point),
       into(row.repeat), into(row.tip_mm.x()), into(row.tip_mm.y()), into(row.tip_mm.z()),
       into(row.approach.x()), into(row.approach.y()), into(row.approach.z()),
       into(temperature.value, temperature.given), into(row.time_s),
       into(scales.value, scales.given));
  rows.execute();
  while (rows.fetch()) {
    row.purpose = named<Touch::Purpose>("touch.purpose", purpose);
    row.temperature_degC = temperature.get();
    row.scale_temperature_degC = scales.get();
    require_touch(row);
    const bool check = row.purpose == Touch::Purpose::kCheck;
    if (check != (row.id < 0)) {
      throw Contradiction(fmt::format("touch {} has the purpose {}", row.id, purpose));
    }
    (check ? record.checks : record.touches).push_back(row);
  }
  std::reverse(record.checks.begin(), record.checks.end());  // their ids count downward
}

void read_decisions(soci::session& sql, RunRecord& record) {
  Decision row;
  std::string code;
  std::string arguments;
  soci::statement rows =
      (sql.prepare << "select feature, time_s, code, arguments from decision order by id",
       into(row.feature), into(row.time_s), into(code), into(arguments));
  rows.execute();
  while (rows.fetch()) {
    if (row.feature != -1) (void)feature_at(record, row.feature, "decision");
    require_number("decision.time_s", row.time_s);
    auto message = read_message(code, arguments);
    if (!message) {
      throw Contradiction(fmt::format("decision holds {} {}, which no run decides",
                                      quoted_text(code), quoted_text(arguments)));
    }
    row.message = *std::move(message);
    take(row, record);
  }
}

void read_results(soci::session& sql, RunRecord& record) {
  StoredResult row;
  soci::statement rows = (sql.prepare << "select name, value from result order by id",
                          into(row.name), into(row.value));
  rows.execute();
  while (rows.fetch()) record.results.push_back(row);
}

/// One object of a schema: table, index, view or trigger.
struct SchemaObject {
  std::string type;
  std::string name;
  std::string table;
  std::string sql;
};

std::vector<SchemaObject> schema_of(soci::session& sql) {
  std::vector<SchemaObject> out;
  SchemaObject row;
  soci::statement rows =
      (sql.prepare << "select coalesce(type, ''), coalesce(name, ''), coalesce(tbl_name, ''), "
                      "coalesce(sql, '') from sqlite_schema",
       into(row.type), into(row.name), into(row.table), into(row.sql));
  rows.execute();
  while (rows.fetch()) out.push_back(row);
  return out;
}

/// Removes from a list of objects the one that is this table; a view or another object of that name
/// stays.
void take_table(std::vector<SchemaObject>& schema, const Table& table) {
  const auto found = std::find_if(schema.begin(), schema.end(), [&](const SchemaObject& object) {
    return object.type == "table" && object.name == table.name;
  });
  if (found == schema.end()) throw Contradiction(fmt::format("it has no table {}", table.name));
  // SQLite stores "CREATE TABLE " in capitals and the text after it as written: the columns with
  // their types, checks and defaults.
  constexpr std::string_view kVerb = "CREATE TABLE ";
  if (!found->sql.starts_with(kVerb) ||
      std::string_view(found->sql).substr(kVerb.size()) != table.sql.substr(kVerb.size())) {
    throw Contradiction(fmt::format("the columns of its table {} are not those of version {}",
                                    table.name, kSchemaVersion));
  }
  schema.erase(found);
}

}  // namespace

void require_schema(soci::session& sql) {
  std::vector<SchemaObject> schema = schema_of(sql);
  for (const Table& table : all_tables()) take_table(schema, table);
  for (const SchemaObject& object : schema) {
    // SQLite's own index for `unique` in table seal.
    const bool of_seal = object.type == "index" && object.name == "sqlite_autoindex_seal_1" &&
                         object.table == seal_table().name && object.sql.empty();
    if (of_seal) continue;
    throw Contradiction(fmt::format(
        "it holds the {} {}{}, which no journal of version {} has: somebody else put it there",
        object.type, quoted_text(object.name),
        object.type == "table" ? std::string() : " on table " + quoted_text(object.table),
        kSchemaVersion));
  }
}

ReadJournal read_tables(soci::session& sql) {
  ReadJournal journal;
  require_journal(sql);
  read_header(sql, journal.record);
  read_artefact(sql, journal.record);
  read_features(sql, journal.record);
  read_search_steps(sql, journal.record);
  read_characteristics(sql, journal.record);
  read_poses(sql, journal.record);
  read_touches(sql, journal.record);
  read_decisions(sql, journal.record);
  read_series_tables(sql, journal.record);
  read_results(sql, journal.record);
  journal.record.sealed = is_sealed(sql);
  journal.broken = check_seal(sql);
  return journal;
}

}  // namespace rondure::record
