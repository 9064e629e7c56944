#include "evaluation/results/age_gate.h"

#include <utility>

#include "core/utc.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
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
