#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/decision/decision.h"

namespace rondure::evaluation {
namespace {

std::string path(std::string_view key) { return fmt::format("decision_rule/{}", key); }

core::Result<DecisionRule::Kind> kind_named(std::string_view name) {
  for (const DecisionRule::Kind kind :
       {DecisionRule::Kind::kSimpleAcceptance, DecisionRule::Kind::kIso14253,
        DecisionRule::Kind::kJcgm106, DecisionRule::Kind::kNToOne,
        DecisionRule::Kind::kGuardBand}) {
    if (name == name_of(kind)) return kind;
  }
  return core::fail(core::Code::kMeaning,
                    fmt::format("this program does not know the decision rule \"{}\"", name));
}

std::optional<Prior> prior_of(const record::RunRecord& record) {
  const auto number = [&](std::string_view key) {
    return record::number_in(record.settings, path(key)).value_or(0.0);
  };
  const auto name = record::word_in(record.settings, path("prior/distribution"));
  if (!name) return std::nullopt;
  return Prior{*name == "normal" ? Prior::Kind::kNormal : Prior::Kind::kGamma,
               number("prior/mean_um") * core::kMicrometre,
               number("prior/standard_deviation_um") * core::kMicrometre};
}

}  // namespace

core::Result<DecisionRule> rule_of(const record::RunRecord& record) {
  const std::string& name = record.header.decision_rule;
  DecisionRule out;
  if (name.empty()) return out;
  const auto kind = kind_named(name);
  if (!kind) return core::fail(kind.error());
  out.kind = *kind;
  const auto number = [&](std::string_view key, double otherwise) {
    return record::number_in(record.settings, path(key)).value_or(otherwise);
  };
  const auto word = [&](std::string_view key) {
    return record::word_in(record.settings, path(key)).value_or(std::string());
  };
  if (word("measurand") == "whole-surface") out.measurand = Measurand::kWholeSurface;
  out.judge_corrected = word("judge") == "corrected";
  out.guard_factor = number("guard_factor", out.guard_factor);
  out.consumer_risk_1 = 0.01 * number("consumer_risk_percent", 5.0);
  out.producer_risk_1 = 0.01 * number("producer_risk_percent", 5.0);
  out.ratio = number("ratio", out.ratio);
  out.acceptance_guard_1 = 0.01 * number("acceptance_guard_percent", 100.0);
  out.rejection_guard_1 = 0.01 * number("rejection_guard_percent", 100.0);
  out.prior = prior_of(record);
  out.zones = word("zones");
  out.outcomes = word("outcomes");
  out.repeats = word("repeats");
  out.outliers = word("outliers");
  return out;
}

}  // namespace rondure::evaluation
