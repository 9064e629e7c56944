#include "record/archive/internal/rows.h"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/archive/internal/schema.h"

namespace rondure::record {
namespace {

using soci::into;
using soci::use;

soci::indicator indicator_of(const std::optional<double>& number) {
  return number ? soci::i_ok : soci::i_null;
}

std::optional<std::int64_t> insert_head(soci::session& sql, const ArchiveHead& head,
                                        std::int64_t time_s) {
  const int simulated = head.simulated ? 1 : 0;
  const std::int64_t serial_key = key_of(head.serial);
  std::int64_t id = 0;
  sql << "insert into rondure_run (journal_sha256, run_id, time_s, started_utc, part_id, "
         "part_name, serial, serial_key, operator_name, machine, fixture, simulated, plan_name, "
         "plan_revision, plan_sha256, version) values (:journal, :run_id, :time_s, :started, "
         ":part, :name, :serial, :serial_key, :operator, :machine, :fixture, :simulated, :plan, "
         ":revision, :plan_sha256, :version) on conflict (journal_sha256) do nothing returning id",
      into(id), use(head.journal_sha256), use(head.run_id), use(time_s), use(head.started_utc),
      use(head.part_id), use(head.part_name), use(head.serial), use(serial_key),
      use(head.operator_name), use(head.machine), use(head.fixture), use(simulated),
      use(head.plan_name), use(head.plan_revision), use(head.plan_sha256), use(head.version);
  if (!sql.got_data()) return std::nullopt;
  return id;
}

void insert_results(soci::session& sql, const ArchiveRun& run, std::int64_t id,
                    std::int64_t time_s) {
  const std::int64_t part_key = key_of(run.head.part_id);
  std::int64_t characteristic_key = 0;
  int number = 0;
  ArchiveResult r;
  double value = 0.0;
  double limit = 0.0;
  soci::indicator value_given = soci::i_ok;
  soci::indicator limit_given = soci::i_ok;
  double lower = 0.0;
  soci::indicator lower_given = soci::i_ok;
  soci::statement insert =
      (sql.prepare << "insert into rondure_result (run, number, time_s, part_key, "
                      "characteristic_key, feature, characteristic, symbol, reference, filter, "
                      "sampling, value, upper_limit, unit, verdict, certificate, lower_limit) "
                      "values (:run, :number, :time_s, :part_key, :characteristic_key, :feature, "
                      ":characteristic, :symbol, :reference, :filter, :sampling, :value, "
                      ":upper_limit, :unit, :verdict, :certificate, :lower_limit)",
       use(id), use(number), use(time_s), use(part_key), use(characteristic_key), use(r.feature),
       use(r.characteristic), use(r.symbol), use(r.reference), use(r.filter), use(r.sampling),
       use(value, value_given), use(limit, limit_given), use(r.unit), use(r.verdict),
       use(r.certificate), use(lower, lower_given));
  for (const ArchiveResult& result : run.results) {
    r = result;
    characteristic_key = key_of(r.characteristic);
    value = r.value.value_or(0.0);
    value_given = indicator_of(r.value);
    limit = r.upper_limit.value_or(0.0);
    limit_given = indicator_of(r.upper_limit);
    lower = r.lower_limit.value_or(0.0);
    lower_given = indicator_of(r.lower_limit);
    insert.execute(true);
    ++number;
  }
}

/// All columns of a result and of its run, in the order of Row.
constexpr std::string_view kSelect =
    "select n.journal_sha256, n.run_id, n.started_utc, n.part_id, n.part_name, n.serial, "
    "n.operator_name, n.machine, n.fixture, n.simulated, n.plan_name, n.plan_revision, "
    "n.plan_sha256, n.version, r.feature, r.characteristic, r.symbol, r.reference, r.filter, "
    "r.sampling, r.value, r.upper_limit, r.lower_limit, r.unit, r.verdict, r.certificate, "
    "r.time_s, r.run, r.number, cast(r.time_s as text), cast(r.number as text) from "
    "rondure_result r join rondure_run n on n.id = r.run";

/// The variables that a fetch writes to.
struct Row {
  ArchivedResult out;
  int simulated = 0;
  double value = 0.0;
  double limit = 0.0;
  double lower = 0.0;
  soci::indicator value_given = soci::i_null;
  soci::indicator limit_given = soci::i_null;
  soci::indicator lower_given = soci::i_null;
  std::string time_text;
  std::string number_text;

  void bind(soci::statement& select) {
    ArchiveHead& h = out.head;
    for (std::string* text : {&h.journal_sha256, &h.run_id, &h.started_utc, &h.part_id,
                              &h.part_name, &h.serial, &h.operator_name, &h.machine, &h.fixture}) {
      select.exchange(into(*text));
    }
    select.exchange(into(simulated));
    ArchiveResult& r = out.result;
    for (std::string* text :
         {&h.plan_name, &h.plan_revision, &h.plan_sha256, &h.version, &r.feature, &r.characteristic,
          &r.symbol, &r.reference, &r.filter, &r.sampling}) {
      select.exchange(into(*text));
    }
    select.exchange(into(value, value_given));
    select.exchange(into(limit, limit_given));
    select.exchange(into(lower, lower_given));
    for (std::string* text : {&r.unit, &r.verdict, &r.certificate}) select.exchange(into(*text));
    select.exchange(into(out.time_s));
    select.exchange(into(out.run));
    select.exchange(into(out.number));
    select.exchange(into(time_text));
    select.exchange(into(number_text));
  }

  [[nodiscard]] const ArchivedResult& fetched() {
    // SQLite reads another type as a number: the page after such a row would begin elsewhere.
    if (time_text != fmt::to_string(out.time_s) || number_text != fmt::to_string(out.number)) {
      throw std::runtime_error(fmt::format(
          "result {} of run {} has the time \"{:.40}\" and the number \"{:.40}\", no whole "
          "numbers: its row was changed, or is damaged",
          out.number, out.run, time_text, number_text));
    }
    out.head.simulated = simulated != 0;
    out.result.value = value_given == soci::i_ok ? std::optional(value) : std::nullopt;
    out.result.upper_limit = limit_given == soci::i_ok ? std::optional(limit) : std::nullopt;
    out.result.lower_limit = lower_given == soci::i_ok ? std::optional(lower) : std::nullopt;
    for (const auto& number : {out.result.value, out.result.upper_limit, out.result.lower_limit}) {
      if (number && !core::is_measurable(*number)) {
        throw std::runtime_error(
            fmt::format("result {} of run {} has a value or limit beyond {:g} {}: its row was "
                        "changed, or is damaged",
                        out.number, out.run, core::kGreatestNumber, out.result.unit));
      }
    }
    return out;
  }
};

/// Compares the names themselves; their keys are equal already, and the names nearly always are.
/// Done here and not in the query: PostgreSQL would treat key and name as independent, expect a
/// handful of rows, and sort all rows of a part instead of reading the newest.
bool is_named(const ArchivedResult& row, const ArchiveFilter& filter) {
  return (!filter.part || *filter.part == row.head.part_id) &&
         (!filter.characteristic || *filter.characteristic == row.result.characteristic) &&
         (!filter.serial || *filter.serial == row.head.serial);
}

/// The conditions of a filter, and the values bound to them. Not movable: SOCI keeps pointers to
/// the values.
class Conditions {
 public:
  Conditions(const ArchiveFilter& filter, const ArchivedResult* before)
      : filter_(filter), before_(before) {
    if (filter.part) part_key_ = key_of(*filter.part);
    if (filter.characteristic) characteristic_key_ = key_of(*filter.characteristic);
    if (filter.serial) serial_key_ = key_of(*filter.serial);
  }

  /// Binds the values and returns " where ...".
  std::string bind(soci::statement& select) {
    number(select, "r.part_key =", part_key_);
    number(select, "r.characteristic_key =", characteristic_key_);
    number(select, "n.serial_key =", serial_key_);
    number(select, "r.time_s >=", filter_.since_s);
    number(select, "r.time_s <=", filter_.until_s);
    text(select, "r.feature =", filter_.feature);
    text(select, "n.machine =", filter_.machine);
    text(select, "n.operator_name =", filter_.operator_name);
    text(select, "r.verdict =", filter_.verdict);
    if (before_ != nullptr) {
      add("(r.time_s, r.run, r.number) < (:t, :u, :n)");
      select.exchange(use(before_->time_s, "t"));
      select.exchange(use(before_->run, "u"));
      select.exchange(use(before_->number, "n"));
    }
    return where_;
  }

 private:
  void add(std::string_view condition) {
    where_ += fmt::format("{}{}", where_.empty() ? " where " : " and ", condition);
  }
  std::string named(std::string_view condition) {
    std::string name = fmt::format("p{}", parameters_++);
    add(fmt::format("{} :{}", condition, name));
    return name;
  }
  void number(soci::statement& select, std::string_view condition,
              const std::optional<std::int64_t>& value) {
    if (value) select.exchange(use(*value, named(condition)));
  }
  void text(soci::statement& select, std::string_view condition,
            const std::optional<std::string>& value) {
    if (value) select.exchange(use(*value, named(condition)));
  }

  const ArchiveFilter& filter_;
  const ArchivedResult* before_;
  std::optional<std::int64_t> part_key_;
  std::optional<std::int64_t> characteristic_key_;
  std::optional<std::int64_t> serial_key_;
  std::string where_;
  int parameters_ = 0;
};

}  // namespace

int archive_version(soci::session& sql) {
  int version = -1;
  sql << "select version from rondure_archive", into(version);
  return version;
}

bool insert_run(soci::session& sql, const ArchiveRun& run, std::int64_t time_s) {
  const auto id = insert_head(sql, run.head, time_s);
  if (!id) return false;
  insert_results(sql, run, *id, time_s);
  return true;
}

std::vector<ArchivedResult> select_newest(soci::session& sql, const ArchiveFilter& filter,
                                          std::size_t count, const ArchivedResult* before) {
  Conditions conditions(filter, before);
  Row row;
  soci::statement select(sql);
  row.bind(select);
  const std::string where = conditions.bind(select);
  select.alloc();
  select.prepare(fmt::format("{}{} order by r.time_s desc, r.run desc, r.number desc limit {}",
                             kSelect, where, count));
  select.define_and_bind();
  std::vector<ArchivedResult> out;
  for (bool more = select.execute(true); more; more = select.fetch()) {
    const ArchivedResult& result = row.fetched();
    if (is_named(result, filter)) out.push_back(result);
  }
  return out;
}

std::optional<ArchiveRun> select_run(soci::session& sql, const std::string& journal_sha256) {
  Row row;
  soci::statement select(sql);
  row.bind(select);
  select.exchange(use(journal_sha256, "journal"));
  select.alloc();
  select.prepare(fmt::format("{} where n.journal_sha256 = :journal order by r.number", kSelect));
  select.define_and_bind();
  std::optional<ArchiveRun> run;
  for (bool more = select.execute(true); more; more = select.fetch()) {
    if (!run) run.emplace(ArchiveRun{row.fetched().head, {}});
    run->results.push_back(row.fetched().result);
  }
  return run;
}

}  // namespace rondure::record
