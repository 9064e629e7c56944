#include <initializer_list>
#include <utility>

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

/// The value for a word of the run; the first one where the run does not have the word.
template <class Value>
core::Result<Value> value_of_word(const record::RunRecord& record, std::string_view key,
                                  std::initializer_list<std::pair<std::string_view, Value>> words) {
  const auto said = record::word_in(record.settings, path(key));
  if (!said) return words.begin()->second;
  for (const auto& [word, value] : words) {
    if (*said == word) return value;
  }
  return core::fail(core::Code::kMeaning,
                    fmt::format("the decision rule has the unknown {} \"{}\"", key, *said));
}

core::Result<std::optional<Prior>> prior_of(const record::RunRecord& record) {
  const auto number = [&](std::string_view key) {
    return record::number_in(record.settings, path(key)).value_or(0.0);
  };
  constexpr std::string_view kDistribution = "prior/distribution";
  if (!record::word_in(record.settings, path(kDistribution))) return std::nullopt;
  const auto kind = value_of_word<Prior::Kind>(
      record, kDistribution, {{"gamma", Prior::Kind::kGamma}, {"normal", Prior::Kind::kNormal}});
  if (!kind) return core::fail(kind.error());
  return Prior{*kind, number("prior/mean_um") * core::kMicrometre,
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
  const auto measurand = value_of_word<Measurand>(
      record, "measurand",
      {{"sampled-points", Measurand::kSampledPoints}, {"whole-surface", Measurand::kWholeSurface}});
  if (!measurand) return core::fail(measurand.error());
  const auto corrected =
      value_of_word<bool>(record, "judge", {{"as-read", false}, {"corrected", true}});
  if (!corrected) return core::fail(corrected.error());
  const auto prior = prior_of(record);
  if (!prior) return core::fail(prior.error());
  out.measurand = *measurand;
  out.judge_corrected = *corrected;
  out.guard_factor = number("guard_factor", out.guard_factor);
  out.consumer_risk_1 = 0.01 * number("consumer_risk_percent", 5.0);
  out.producer_risk_1 = 0.01 * number("producer_risk_percent", 5.0);
  out.ratio = number("ratio", out.ratio);
  out.acceptance_guard_1 = 0.01 * number("acceptance_guard_percent", 100.0);
  out.rejection_guard_1 = 0.01 * number("rejection_guard_percent", 100.0);
  out.prior = *prior;
  out.zones = word("zones");
  out.outcomes = word("outcomes");
  out.repeats = word("repeats");
  out.outliers = word("outliers");
  return out;
}

}  // namespace rondure::evaluation
