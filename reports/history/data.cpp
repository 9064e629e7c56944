#include <cmath>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/data/internal/json_parts.h"
#include "reports/escaping.h"
#include "reports/history/history.h"

namespace rondure::reports {
namespace {

/// Lengths leave the program in um, angles in urad; values in other units stay unchanged.
std::optional<double> outside(const std::optional<double>& value, const std::string& unit) {
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return unit == "mm" || unit == "mrad" ? *value / core::kMicrometre : *value;
}
std::string outside_unit(const std::string& unit) {
  return unit == "mm" || unit == "mrad" ? std::string(name_of(unit_of_archive(unit))) : unit;
}

/// The fields of a result, for the JSON and, in this order, for the CSV file.
Json result_json(const record::ArchivedResult& r) {
  return {{"run_id", r.head.run_id},
          {"started_utc", r.head.started_utc},
          {"part", r.head.part_id},
          {"part_name", r.head.part_name},
          {"serial", r.head.serial},
          {"operator", r.head.operator_name},
          {"machine", r.head.machine},
          {"fixture", r.head.fixture},
          {"simulated", r.head.simulated},
          {"feature", r.result.feature},
          {"characteristic", r.result.characteristic},
          {"symbol", r.result.symbol},
          {"reference", r.result.reference},
          {"filter", r.result.filter},
          {"sampling", r.result.sampling},
          {"value", optional_json(outside(r.result.value, r.result.unit))},
          {"limit", optional_json(outside(r.result.upper_limit, r.result.unit))},
          {"unit", outside_unit(r.result.unit)},
          {"verdict", r.result.verdict},
          {"certificate", r.result.certificate},
          {"plan", r.head.plan_name},
          {"plan_revision", r.head.plan_revision},
          {"plan_sha256", r.head.plan_sha256},
          {"journal_sha256", r.head.journal_sha256},
          {"version", r.head.version},
          {"lower_limit", optional_json(outside(r.result.lower_limit, r.result.unit))}};
}

Json um_json(double mm) { return mm / core::kMicrometre; }

Json chart_json(const RunChart& chart) {
  if (chart.results.empty()) return nullptr;
  const record::ArchivedResult& newest = chart.results.back();
  const std::string suffix = "_" + std::string(name_of(unit_of(chart)));
  Json out = {{"part", newest.head.part_id},
              {"feature", newest.result.feature},
              {"characteristic", newest.result.characteristic},
              {"results", chart.results.size()},
              {"control_limits", nullptr},
              {"beyond_control_limits", Json::array()},
              {"capability", nullptr},
              {"notes", chart.notes}};
  if (chart.limits) {
    out["control_limits"] = {{"method", "I-MR chart of ln x"},
                             {"lower" + suffix, um_json(chart.limits->lower_mm)},
                             {"center" + suffix, um_json(chart.limits->center_mm)},
                             {"upper" + suffix, um_json(chart.limits->upper_mm)}};
  }
  for (const std::size_t i : chart.beyond) {
    out["beyond_control_limits"].push_back(chart.results[i].head.run_id);
  }
  if (!chart.capability) return out;
  const Capability& c = *chart.capability;
  const bool model = c.method == Capability::Method::kLogNormal;
  out["capability"] = {{"name", chart.index_name},
                       {"index", c.index},
                       {"lower_bound_95", optional_json(c.lower_bound)},
                       {"percentiles_of", model ? "log-normal" : "sample"},
                       {"median" + suffix, um_json(c.median_mm)},
                       {"point_99_865" + suffix, um_json(c.upper_point_mm)},
                       {"anderson_darling_p", c.fit_p}};
  return out;
}

}  // namespace

std::string history_csv_header() {
  std::string out;
  const Json fields = result_json({});
  for (const auto& [key, value] : fields.items()) out += (out.empty() ? "" : ",") + key;
  return out + "\n";
}

std::string history_csv_rows(std::span<const record::ArchivedResult> newest_first) {
  std::string out;
  for (const record::ArchivedResult& r : newest_first) {
    const char* separator = "";
    for (const Json& value : result_json(r)) {
      out += separator;
      out += value.is_string()    ? csv_field(value.get<std::string>())
             : value.is_number()  ? core::shortest(value.get<double>())
             : value.is_boolean() ? (value.get<bool>() ? "1" : "0")
                                  : "";
      separator = ",";
    }
    out += "\n";
  }
  return out;
}

std::string history_json(const std::string& archive,
                         std::span<const record::ArchivedResult> newest_first, bool more,
                         const RunChart& chart) {
  Json out = {{"archive", archive}, {"more", more}, {"results", Json::array()}};
  for (const record::ArchivedResult& r : newest_first) out["results"].push_back(result_json(r));
  out["chart"] = chart_json(chart);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rondure::reports
