#include "reports/history/earlier_results.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/json_text.h"
#include "core/numbers.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/data/internal/json_parts.h"
#include "reports/history/archive_entry.h"

namespace rondure::reports {
namespace {

using record::ArchivedResult;
using record::ArchiveHead;
using record::ArchiveResult;

/// Texts of a head and of a result with their keys, for reading and writing.
constexpr std::array<std::pair<const char*, std::string ArchiveHead::*>, 13> kHeadTexts = {
    {{"journal_sha256", &ArchiveHead::journal_sha256},
     {"run_id", &ArchiveHead::run_id},
     {"started_utc", &ArchiveHead::started_utc},
     {"part", &ArchiveHead::part_id},
     {"part_name", &ArchiveHead::part_name},
     {"serial", &ArchiveHead::serial},
     {"operator", &ArchiveHead::operator_name},
     {"machine", &ArchiveHead::machine},
     {"fixture", &ArchiveHead::fixture},
     {"plan", &ArchiveHead::plan_name},
     {"plan_revision", &ArchiveHead::plan_revision},
     {"plan_sha256", &ArchiveHead::plan_sha256},
     {"version", &ArchiveHead::version}}};
constexpr std::array<std::pair<const char*, std::string ArchiveResult::*>, 9> kResultTexts = {
    {{"feature", &ArchiveResult::feature},
     {"characteristic", &ArchiveResult::characteristic},
     {"symbol", &ArchiveResult::symbol},
     {"reference", &ArchiveResult::reference},
     {"filter", &ArchiveResult::filter},
     {"sampling", &ArchiveResult::sampling},
     {"unit", &ArchiveResult::unit},
     {"verdict", &ArchiveResult::verdict},
     {"certificate", &ArchiveResult::certificate}}};

std::optional<double> optional_of(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

Json json_of(const ArchivedResult& r) {
  Json out;
  for (const auto& [key, member] : kHeadTexts) out[key] = r.head.*member;
  for (const auto& [key, member] : kResultTexts) out[key] = r.result.*member;
  out["simulated"] = r.head.simulated;
  out["value"] = optional_json(r.result.value);
  out["upper_limit"] = optional_json(r.result.upper_limit);
  out["time_s"] = r.time_s;
  out["number"] = r.number;
  if (r.result.lower_limit) out["lower_limit"] = *r.result.lower_limit;
  return out;
}

ArchivedResult result_of(const Json& json) {
  ArchivedResult out;
  for (const auto& [key, member] : kHeadTexts) out.head.*member = json.at(key).get<std::string>();
  for (const auto& [key, member] : kResultTexts) {
    out.result.*member = json.at(key).get<std::string>();
  }
  out.head.simulated = json.at("simulated").get<bool>();
  out.result.value = optional_of(json.at("value"));
  out.result.upper_limit = optional_of(json.at("upper_limit"));
  if (json.contains("lower_limit")) out.result.lower_limit = optional_of(json["lower_limit"]);
  out.time_s = json.at("time_s").get<std::int64_t>();
  out.number = json.at("number").get<int>();
  return out;
}

}  // namespace

std::string earlier_json(const EarlierResults& earlier) {
  Json rows = Json::array();
  for (const ArchivedResult& r : earlier) rows.push_back(json_of(r));
  return Json({{"results", std::move(rows)}}).dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

core::Result<EarlierResults> parse_earlier(const std::string& text) {
  TRY(const auto document, core::read_json<Json>(text, kEarlierName));
  EarlierResults out;
  try {
    for (const Json& row : document.at("results")) {
      out.push_back(result_of(row));
      const record::ArchiveResult& result = out.back().result;
      if (core::is_measurable(result.value.value_or(0.0)) &&
          core::is_measurable(result.upper_limit.value_or(0.0)) &&
          core::is_measurable(result.lower_limit.value_or(0.0))) {
        continue;
      }
      return core::fail(core::Code::kSyntax,
                        fmt::format("{} does not hold earlier results: number {} has a value or "
                                    "limit beyond {:g}",
                                    kEarlierName, out.size(), core::kGreatestNumber),
                        kEarlierName);
    }
    return out;
  } catch (const Json::exception&) {
    return core::fail(core::Code::kSyntax,
                      fmt::format("{} does not hold earlier results: a key of number {} is "
                                  "missing, or has a value of another kind",
                                  kEarlierName, out.size() + 1),
                      kEarlierName);
  }
}

core::Result<EarlierResults> read_earlier(const std::filesystem::path& directory) {
  std::error_code unknown;  // a link that leads nowhere is not absent
  const auto there = std::filesystem::symlink_status(directory / kEarlierName, unknown);
  if (there.type() == std::filesystem::file_type::not_found) return EarlierResults();
  TRY(const auto text, record::read_inside(directory, kEarlierName));
  return parse_earlier(text);
}

core::Result<void> keep_earlier(const std::filesystem::path& directory,
                                const EarlierResults& earlier) {
  if (earlier.empty()) return {};
  const std::string text = earlier_json(earlier);
  if (auto written = record::write_file(directory / kEarlierName, text); !written) return written;
  return record::update_checksums(directory, {{kEarlierName, record::sha256_hex(text)}});
}

std::vector<RunChart> run_charts(const record::RunRecord& record,
                                 const evaluation::Evaluation& evaluation,
                                 const EarlierResults& earlier) {
  std::vector<RunChart> charts;
  if (earlier.empty()) return charts;
  const record::ArchiveRun own = archive_entry(record, evaluation, "");
  for (const ArchiveResult& result : own.results) {
    std::vector<ArchivedResult> rows = {
        {own.head, result, record::seconds_of_utc(own.head.started_utc).value_or(0), 0, 0}};
    for (const ArchivedResult& r : earlier) {
      if (r.head.part_id == own.head.part_id && r.result.feature == result.feature &&
          r.result.characteristic == result.characteristic) {
        rows.push_back(r);
      }
    }
    RunChart chart = run_chart_of(rows);
    if (chart.results.size() >= 2) charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace rondure::reports
