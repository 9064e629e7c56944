#include "record/journal/internal/rows.h"

#include <cstdint>

#include <fmt/format.h>

#include "record/journal/internal/schema.h"
#include "record/journal/internal/series.h"

namespace rondure::record {
namespace {

using soci::use;

void make_tables(soci::session& sql) {
  sql << fmt::format("pragma application_id = {}", kApplicationId);
  sql << fmt::format("pragma user_version = {}", kSchemaVersion);
  for (const Table& table : all_tables()) sql << table.sql;
}

void insert_header(soci::session& sql, const Header& h) {
  const int simulated = h.simulated ? 1 : 0;
  const std::string seed = std::to_string(h.seed);  // SQLite has no unsigned integers
  sql << "insert into header values (0, :run_id, :version, :processor, :started, :plan_file, "
         ":plan_name, :plan_revision, :plan_text, :plan_sha256, :part_id, :part_name, :drawing, "
         ":serial, :operator, :machine, :fixture, :rule, :simulated, :seed, :min, :max, '', null, "
         "null, null)",
      use(h.run_id), use(h.version), use(h.processor), use(h.started_utc), use(h.plan_file),
      use(h.plan_name), use(h.plan_revision), use(h.plan_text), use(h.plan_sha256), use(h.part_id),
      use(h.part_name), use(h.drawing), use(h.serial), use(h.operator_name), use(h.machine),
      use(h.fixture), use(h.decision_rule), use(simulated), use(seed), use(h.temperature_min_degC),
      use(h.temperature_max_degC);
}

void insert_artefact(soci::session& sql, const Artefact& artefact) {
  sql << "insert into artefact values (0, :radius, :tip, :tolerance, :form)",
      use(artefact.radius_mm), use(artefact.nominal_tip_radius_mm),
      use(artefact.radius_tolerance_mm), use(artefact.form_limit_mm);
}

void insert_characteristic(soci::session& sql, int feature, const Characteristic& c) {
  const std::string form(name_of(c.form));
  const std::string reference(name_of(c.reference));
  Measured tolerance_mm;
  tolerance_mm.take(c.tolerance_mm, "tolerance_mm of " + c.id);
  Measured lower_mm;
  lower_mm.take(c.lower_mm, "lower_mm of " + c.id);
  sql << "insert into characteristic (feature, name, form, reference, tolerance_mm, drawing_zone, "
         "lower_mm) values (:feature, :name, :form, :reference, :tolerance, :zone, :lower)",
      use(feature), use(c.id), use(form), use(reference),
      use(tolerance_mm.value, tolerance_mm.given), use(c.drawing_zone),
      use(lower_mm.value, lower_mm.given);
  insert_keys_of_characteristic(sql, c);
}

void insert_feature(soci::session& sql, int id, const Feature& f) {
  const std::string shape(name_of(f.shape));
  const std::string side(name_of(f.side));
  const std::string strategy(name_of(f.strategy));
  Measured tip_radius_mm;
  tip_radius_mm.take(f.tip_radius_mm, "tip_radius_mm of " + f.id);
  sql << "insert into feature values (:id, :name, :shape, :side, :diameter, :layers, :points, "
         ":strategy, :file, :sha256, :tip)",
      use(id), use(f.id), use(shape), use(side), use(f.nominal_diameter_mm), use(f.layers),
      use(f.points_per_layer), use(strategy), use(f.points_file), use(f.points_sha256),
      use(tip_radius_mm.value, tip_radius_mm.given);
  for (const double step_deg : f.search_steps_deg) {
    sql << "insert into search_step (feature, step_deg) values (:feature, :step)", use(id),
        use(step_deg);
  }
  for (const Characteristic& characteristic : f.characteristics) {
    insert_characteristic(sql, id, characteristic);
  }
  insert_settings(sql, id, f.settings);
}

}  // namespace

Statements::Statements(soci::session& sql)
    : insert_touch((
          sql.prepare << "insert into touch values (:id, :purpose, :pose, :layer, :point, :repeat, "
                         ":tx, :ty, :tz, :ax, :ay, :az, :temperature, :time, :scales)",
          use(touch.id), use(purpose), use(touch.pose), use(touch.layer), use(touch.point),
          use(touch.repeat), use(touch.tip_mm.x()), use(touch.tip_mm.y()), use(touch.tip_mm.z()),
          use(touch.approach.x()), use(touch.approach.y()), use(touch.approach.z()),
          use(temperature_degC.value, temperature_degC.given), use(touch.time_s),
          use(scale_temperature_degC.value, scale_temperature_degC.given))),
      insert_pose((sql.prepare << "insert into pose values (:id, :feature, :ca, :cb, :ra, :rb, "
                                  ":final, :time)",
                   use(pose.id), use(pose.feature), use(pose.commanded.alpha_rad),
                   use(pose.commanded.beta_rad), use(pose.reached.alpha_rad),
                   use(pose.reached.beta_rad), use(final_cloud), use(pose.time_s))),
      insert_decision((sql.prepare << "insert into decision (feature, time_s, code, arguments) "
                                      "values (:f, :t, :c, :a)",
                       use(decision.feature), use(decision.time_s), use(decision_code),
                       use(decision_arguments))),
      update_final(
          (sql.prepare << "update pose set final_cloud = 1 where id = :id", use(marked_pose))) {}

void insert_head(soci::session& sql, const Header& header, const Artefact& artefact,
                 std::span<const Feature> features, std::span<const Setting> settings) {
  soci::transaction transaction(sql);
  make_tables(sql);
  insert_header(sql, header);
  insert_artefact(sql, artefact);
  for (std::size_t i = 0; i < features.size(); ++i) {
    insert_feature(sql, static_cast<int>(i), features[i]);
  }
  insert_settings(sql, kWholeRun, settings);
  Chain chain(sql);
  for (const Table& table : chained_tables()) chain.append_all(table.name);
  transaction.commit();
}

void insert_results(soci::session& sql, Chain& chain, std::span<const StoredResult> results) {
  std::int64_t id = 0;
  StoredResult row;
  soci::statement insert = (sql.prepare << "insert into result values (:id, :name, :value)",
                            use(id), use(row.name), use(row.value));
  for (const StoredResult& result : results) {
    row = result;
    insert.execute(true);
    chain.append("result", id, row.name, row.value);
    ++id;
  }
}

}  // namespace rondure::record
