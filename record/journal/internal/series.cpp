#include "record/journal/internal/series.h"
#include "record/journal/internal/schema.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/internal/database.h"
#include "record/journal/internal/chain.h"
#include "record/journal/internal/values.h"
#include "record/tasks/settings.h"

namespace rondure::record {
namespace {

using soci::into;
using soci::use;

/// One line per row, numbers in the shortest form that reads back to the same bits.
std::string block_text(std::span<const double> values, std::size_t columns) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += core::shortest(values[i]);
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  return text;
}

void require_series(const Series& series) {
  if (series.columns.empty() || series.values.size() % series.columns.size() != 0) {
    throw std::runtime_error(fmt::format("series {} has {} values in {} columns", series.name,
                                         series.values.size(), series.columns.size()));
  }
  const auto bad = std::find_if_not(series.values.begin(), series.values.end(),
                                    [](double value) { return core::is_measurable(value); });
  if (bad == series.values.end()) return;
  const auto at = static_cast<std::size_t>(bad - series.values.begin());
  throw std::runtime_error(fmt::format("{} of series {} is not a finite number up to 1e9 in row {}",
                                       series.columns[at % series.columns.size()].name, series.name,
                                       at / series.columns.size()));
}

std::int64_t last_row(soci::session& sql) {
  return sqlite_api::sqlite3_last_insert_rowid(handle_of(sql));
}

void insert_blocks(soci::session& sql, Chain& chain, std::int64_t id, const Series& series) {
  const std::size_t columns = series.columns.size();
  const std::span<const double> all(series.values);
  for (std::size_t first = 0; first < series.rows(); first += kBlockRows) {
    const std::size_t count = std::min(kBlockRows, series.rows() - first);
    const std::string rows = block_text(all.subspan(first * columns, count * columns), columns);
    const auto first_row = static_cast<std::int64_t>(first);
    const auto row_count = static_cast<std::int64_t>(count);
    sql << "insert into series_block (series, first_row, row_count, rows) values (:series, :first, "
           ":count, :rows)",
        use(id), use(first_row), use(row_count), use(rows);
    chain.append_inserted("series_block", id, first_row, row_count, rows);
  }
}

void insert_one(soci::session& sql, Chain& chain, const Series& series) {
  require_series(series);
  const std::string role(name_of(series.role));
  const auto rows = static_cast<std::int64_t>(series.rows());
  sql << "insert into series (feature, name, role, row_count) values (:feature, :name, :role, "
         ":rows)",
      use(series.feature), use(series.name), use(role), use(rows);
  const std::int64_t id = last_row(sql);
  chain.append("series", id, series.feature, series.name, role, rows);
  for (const SeriesColumn& column : series.columns) {
    sql << "insert into series_column (series, name, unit) values (:series, :name, :unit)", use(id),
        use(column.name), use(column.unit);
    chain.append_inserted("series_column", id, column.name, column.unit);
  }
  insert_blocks(sql, chain, id, series);
}

void read_settings(soci::session& sql, RunRecord& record) {
  int feature = 0;
  Setting row;
  Measured number;
  soci::statement rows =
      (sql.prepare << "select feature, name, number, text from setting order by id", into(feature),
       into(row.name), into(number.value, number.given), into(row.text));
  rows.execute();
  while (rows.fetch()) {
    row.number = number.get();
    require_number("setting.number", row.number.value_or(0.0));
    (feature == kWholeRun ? record.settings : feature_at(record, feature, "setting").settings)
        .push_back(row);
  }
}

/// The characteristics of all features by their id in the journal.
std::map<std::int64_t, Characteristic*> characteristics_by_id(soci::session& sql,
                                                              RunRecord& record) {
  std::map<std::int64_t, Characteristic*> out;
  std::vector<std::size_t> taken(record.features.size(), 0);
  std::int64_t id = 0;
  int feature = 0;
  soci::statement rows = (sql.prepare << "select id, feature from characteristic order by id",
                          into(id), into(feature));
  rows.execute();
  while (rows.fetch()) {
    Feature& owner = feature_at(record, feature, "characteristic");
    out[id] = &owner.characteristics[taken[static_cast<std::size_t>(feature)]++];
  }
  return out;
}

void read_harmonic_limits(soci::session& sql, RunRecord& record) {
  const auto owners = characteristics_by_id(sql, record);
  std::int64_t owner = 0;
  HarmonicLimit row;
  soci::statement rows =
      (sql.prepare << "select characteristic, first_order, last_order, amplitude_mm from "
                      "harmonic_limit order by id",
       into(owner), into(row.first), into(row.last), into(row.amplitude_mm));
  rows.execute();
  while (rows.fetch()) {
    const auto found = owners.find(owner);
    if (found == owners.end()) {
      throw Contradiction(
          fmt::format("table harmonic_limit names characteristic {}, which is missing", owner));
    }
    require_number("harmonic_limit.amplitude_mm", row.amplitude_mm);
    found->second->harmonic_limits.push_back(row);
  }
}

/// Reads what drawings indicate.
void read_indications(soci::session& sql, RunRecord& record) {
  std::map<std::int64_t, std::vector<Setting>> settings;
  const auto owners = characteristics_by_id(sql, record);
  std::int64_t owner = 0;
  Setting row;
  Measured number;
  soci::statement rows =
      (sql.prepare << "select characteristic, name, number, text from characteristic_setting order "
                      "by id",
       into(owner), into(row.name), into(number.value, number.given), into(row.text));
  rows.execute();
  while (rows.fetch()) {
    if (!owners.contains(owner)) {
      throw Contradiction(fmt::format(
          "table characteristic_setting names characteristic {}, which is missing", owner));
    }
    row.number = number.get();
    require_number("characteristic_setting.number", row.number.value_or(0.0));
    settings[owner].push_back(row);
  }
  for (const auto& [id, own] : settings) {
    Characteristic& characteristic = *owners.at(id);
    const auto indication = task_of<Indication>(own);
    if (!indication) {
      throw Contradiction(fmt::format("characteristic {}: {}", quoted_text(characteristic.id),
                                      indication.error().what));
    }
    characteristic.indication = *indication;
  }
}

/// Adds the numbers of a block to a series.
void take_block(std::string_view text, std::int64_t rows, Series& series) {
  const std::size_t before = series.values.size();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(",\n"), text.size());
    const auto value = core::parse_number(text.substr(0, end));
    if (!value) {
      throw Damage(fmt::format("it is damaged: a block of series {} holds {}, no number up to {:g}",
                               quoted_text(series.name), quoted_text(text.substr(0, end)),
                               core::kGreatestNumber));
    }
    series.values.push_back(*value);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const std::size_t expected = static_cast<std::size_t>(rows) * series.columns.size();
  if (rows < 0 || series.values.size() - before != expected) {
    throw Damage(
        fmt::format("it is damaged: a block of series {} has {} numbers, {} rows of {} columns "
                    "are stated",
                    series.name, series.values.size() - before, rows, series.columns.size()));
  }
}

/// A series by its id in the journal, and the number of rows it states.
struct Stated {
  Series series;
  std::int64_t rows = 0;
};
using StatedSeries = std::map<std::int64_t, Stated>;

Series& series_at(StatedSeries& all, std::int64_t id, std::string_view table) {
  const auto found = all.find(id);
  if (found == all.end()) {
    throw Contradiction(fmt::format("table {} names series {}, which is missing", table, id));
  }
  return found->second.series;
}

StatedSeries read_series_heads(soci::session& sql, RunRecord& record) {
  StatedSeries all;
  std::int64_t id = 0;
  Stated row;
  std::string role;
  soci::statement rows =
      (sql.prepare << "select id, feature, name, role, row_count from series order by id", into(id),
       into(row.series.feature), into(row.series.name), into(role), into(row.rows));
  rows.execute();
  while (rows.fetch()) {
    (void)feature_at(record, row.series.feature, "series");
    row.series.role = named<Series::Role>("series.role", role);
    all[id] = row;
  }
  return all;
}

void read_series_columns(soci::session& sql, StatedSeries& all) {
  std::int64_t series = 0;
  SeriesColumn row;
  soci::statement rows = (sql.prepare << "select series, name, unit from series_column order by id",
                          into(series), into(row.name), into(row.unit));
  rows.execute();
  while (rows.fetch()) series_at(all, series, "series_column").columns.push_back(row);
}

void read_series_blocks(soci::session& sql, StatedSeries& all) {
  std::int64_t series = 0;
  std::int64_t first = 0;
  std::int64_t count = 0;
  std::string text;
  soci::statement rows =
      (sql.prepare << "select series, first_row, row_count, rows from series_block order by id",
       into(series), into(first), into(count), into(text));
  rows.execute();
  while (rows.fetch()) {
    Series& owner = series_at(all, series, "series_block");
    if (first != static_cast<std::int64_t>(owner.rows())) {
      throw Damage(fmt::format("it is damaged: series {} goes on with row {}, row {} is expected",
                               quoted_text(owner.name), first, owner.rows()));
    }
    take_block(text, count, owner);
  }
}

void read_series(soci::session& sql, RunRecord& record) {
  StatedSeries all = read_series_heads(sql, record);
  read_series_columns(sql, all);
  read_series_blocks(sql, all);
  for (auto& [id, stated] : all) {
    if (stated.rows != static_cast<std::int64_t>(stated.series.rows())) {
      throw Damage(fmt::format("it is damaged: series {} has {} rows, {} are stated",
                               quoted_text(stated.series.name), stated.series.rows(), stated.rows));
    }
    record.series.push_back(std::move(stated.series));
  }
}

void read_truth_values(soci::session& sql, RunRecord& record) {
  TruthValue row;
  soci::statement rows = (sql.prepare << "select feature, name, value from truth_value order by id",
                          into(row.feature), into(row.name), into(row.value));
  rows.execute();
  while (rows.fetch()) {
    (void)feature_at(record, row.feature, "truth_value");
    require_number("truth_value.value", row.value);
    record.truth_values.push_back(row);
  }
}

}  // namespace

void insert_settings(soci::session& sql, int feature, std::span<const Setting> settings) {
  for (const Setting& setting : settings) {
    Measured number;
    number.take(setting.number, setting.name);
    sql << "insert into setting (feature, name, number, text) values (:feature, :name, :number, "
           ":text)",
        use(feature), use(setting.name), use(number.value, number.given), use(setting.text);
  }
}

void insert_keys_of_characteristic(soci::session& sql, const Characteristic& c) {
  const std::int64_t characteristic = last_row(sql);
  for (const Setting& setting : settings_of_task(c.indication)) {
    Measured number;
    number.take(setting.number, setting.name);
    sql << "insert into characteristic_setting (characteristic, name, number, text) values "
           "(:owner, :name, :number, :text)",
        use(characteristic), use(setting.name), use(number.value, number.given), use(setting.text);
  }
  for (const HarmonicLimit& limit : c.harmonic_limits) {
    sql << "insert into harmonic_limit (characteristic, first_order, last_order, amplitude_mm) "
           "values (:owner, :first, :last, :amplitude)",
        use(characteristic), use(limit.first), use(limit.last), use(limit.amplitude_mm);
  }
}

void insert_series(soci::session& sql, Chain& chain, std::span<const Series> series,
                   std::span<const TruthValue> truths) {
  for (const Series& one : series) insert_one(sql, chain, one);
  for (const TruthValue& truth : truths) {
    sql << "insert into truth_value (feature, name, value) values (:feature, :name, :value)",
        use(truth.feature), use(truth.name), use(truth.value);
    chain.append_inserted("truth_value", truth.feature, truth.name, truth.value);
  }
}

void read_series_tables(soci::session& sql, RunRecord& record) {
  read_settings(sql, record);
  read_harmonic_limits(sql, record);
  read_indications(sql, record);
  read_series(sql, record);
  read_truth_values(sql, record);
}

}  // namespace rondure::record
