#include "evaluation/results/gates.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/utc.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using Outcome = Gate::Outcome;

Gate named(std::string code, core::Phrase condition) {
  Gate out;
  out.code = std::move(code);
  out.condition = std::move(condition);
  return out;
}

/// Why there is no temperature, and what to do.
core::Phrase not_measured(const record::Header& header, record::Strategy strategy) {
  if (strategy == record::Strategy::kSeries) {
    return core::phrase(
        "the temperature was not recorded, the limits are {:g}..{:g} degC: give the data a column "
        "temperature_degC, or declare environment.assumed_degC in the plan",
        header.temperature_min_degC, header.temperature_max_degC);
  }
  return core::phrase(
      "the temperature was not measured, the limits are {:g}..{:g} degC: use a sensor that the "
      "machine reports, or declare environment.assumed_degC in the plan",
      header.temperature_min_degC, header.temperature_max_degC);
}

/// How far a temperature lies inside the limits; below 0 outside.
double margin_K(double degC, const record::Header& header) {
  return std::min(degC - header.temperature_min_degC, header.temperature_max_degC - degC);
}

Gate limits_gate(const record::Header& header, const FeatureResult& result) {
  Gate out = named("temperature", core::phrase("temperature within the limits of the plan"));
  out.unit = "degC";
  if (!result.temperatures) {
    out.outcome = Outcome::kVoids;
    out.reason = not_measured(header, result.feature.strategy);
    return out;
  }
  const Temperatures& found = *result.temperatures;
  const bool colder = margin_K(found.least_degC, header) <= margin_K(found.greatest_degC, header);
  const double worst_degC = colder ? found.least_degC : found.greatest_degC;
  const double middle_degC = 0.5 * (header.temperature_min_degC + header.temperature_max_degC);
  out.found = worst_degC;
  out.limit = worst_degC < middle_degC ? header.temperature_min_degC : header.temperature_max_degC;
  if (margin_K(worst_degC, header) >= 0.0) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase("temperature {:.2f} degC is outside {:g}..{:g} degC", worst_degC,
                            header.temperature_min_degC, header.temperature_max_degC);
  return out;
}

Gate drift_gate(double max_drift_K, const FeatureResult& result) {
  Gate out = named("temperature-drift", core::phrase("change of the temperature at one place"));
  out.unit = "K";
  out.limit = max_drift_K;
  if (result.temperatures) out.found = result.temperatures->drift_K;
  if (!out.found || *out.found <= max_drift_K) return out;
  out.outcome = Outcome::kVoids;
  out.reason = core::phrase(
      "the temperature changed by {:.2f} K at one place while it was measured, the limit is {:g} K "
      "(environment.max_drift_K): wait until it is steady, and measure again",
      *out.found, max_drift_K);
  return out;
}

}  // namespace

std::vector<Gate> temperature_gates(const record::RunRecord& record, const FeatureResult& result) {
  const bool touched = result.feature.strategy != record::Strategy::kPointsFile &&
                       result.feature.strategy != record::Strategy::kSeries;
  const auto stated = record::task_of<record::EnvironmentSettings>(record.settings, "environment/");
  if (!stated) {
    Gate unread = named("temperature", core::phrase("temperature within the limits of the plan"));
    unread.outcome = Outcome::kVoids;
    unread.reason = stated.error().said();
    return {unread};
  }
  if (!touched && !stated->declared) return {};
  std::vector<Gate> out = {limits_gate(record.header, result)};
  if (record::is_analysis(result.feature.shape)) {
    out.push_back(drift_gate(stated->max_drift_K, result));
  }
  return out;
}

namespace {

constexpr double kSecondsOfDay = 86'400.0;

}  // namespace

std::optional<Gate> age_gate(const record::RunRecord& record, const record::Feature& feature) {
  const auto stated = record::task_of<record::SourceSettings>(feature.settings, "source/");
  if (stated && !stated->measured_utc) return std::nullopt;
  Gate out;
  out.code = "stale-input";
  out.condition = core::phrase("age of the data at the start of the run");
  out.unit = "d";
  const auto refuse = [&](core::Phrase reason) {
    out.outcome = Gate::Outcome::kVoids;
    out.reason = std::move(reason);
    return out;
  };
  if (!stated) return refuse(stated.error().said());
  out.limit = stated->valid_for_days;
  const auto measured = core::parse_utc(*stated->measured_utc);
  const auto started = core::parse_utc(record.header.started_utc);
  if (!measured || !started) {
    return refuse(core::phrase(
        "the age of the data is not known: they were measured at \"{}\", the run began at \"{}\"",
        *stated->measured_utc, record.header.started_utc));
  }
  out.found = static_cast<double>(*started - *measured) / kSecondsOfDay;
  if (*out.found < 0.0) {
    return refuse(core::phrase(
        "the data were measured at {}, after the start of the run at {}: correct measured_utc, or "
        "the clock",
        *stated->measured_utc, record.header.started_utc));
  }
  if (!out.limit || *out.found <= *out.limit) return out;
  return refuse(
      core::phrase("the data were measured at {} and are {:.4g} days old, they stand for {:g} days "
                   "(valid_for_days): measure again",
                   *stated->measured_utc, *out.found, *out.limit));
}

std::optional<core::Phrase> age_fault(const record::RunRecord& record,
                                      const record::Feature& feature) {
  auto gate = age_gate(record, feature);
  if (!gate || gate->outcome != Gate::Outcome::kVoids) return std::nullopt;
  return std::move(gate->reason);
}

}  // namespace rondure::evaluation
