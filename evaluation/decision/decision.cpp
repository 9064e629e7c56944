#include "evaluation/decision/decision.h"

#include <algorithm>
#include <array>

#include "core/units.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {

int severity(Verdict verdict) {
  constexpr std::array kOrder = {Verdict::kNotToleranced, Verdict::kConforms, Verdict::kUndecided,
                                 Verdict::kVoid, Verdict::kDoesNotConform};
  return static_cast<int>(std::find(kOrder.begin(), kOrder.end(), verdict) - kOrder.begin());
}

using record::DecisionRuleTask;

Measurand measurand_of(DecisionRuleTask::Measurand asked) {
  return asked == DecisionRuleTask::Measurand::kWholeSurface ? Measurand::kWholeSurface
                                                             : Measurand::kSampledPoints;
}

DecisionRule rule_of(const DecisionRuleTask& task) {
  DecisionRule out;
  out.kind = task.rule;
  out.measurand = measurand_of(task.measurand);
  out.judge_corrected = task.judge == DecisionRuleTask::Judge::kCorrected;
  out.guard_factor = task.guard_factor;
  out.consumer_risk_1 = 0.01 * task.consumer_risk_percent;
  out.producer_risk_1 = 0.01 * task.producer_risk_percent;
  if (const auto& prior = task.prior) {
    out.prior = Prior{prior->distribution, prior->mean_um * core::kMicrometre,
                      prior->standard_deviation_um * core::kMicrometre};
  }
  out.ratio = task.ratio;
  out.acceptance_guard_1 = 0.01 * task.acceptance_guard_percent;
  out.rejection_guard_1 = 0.01 * task.rejection_guard_percent;
  out.zones = task.zones;
  out.outcomes = task.outcomes;
  out.repeats = task.repeats;
  out.outliers = task.outliers;
  return out;
}

core::Result<DecisionRule> rule_of(const record::RunRecord& record) {
  const std::string& name = record.header.decision_rule;
  if (name.empty()) return DecisionRule();
  const auto kind = record::value_named<DecisionRule::Kind>(name);
  if (!kind) {
    return core::fail_with(core::Code::kMeaning,
                           "this program does not know the decision rule \"{}\"", name);
  }
  TRY(auto task, record::task_of<DecisionRuleTask>(record.settings, "decision_rule/"));
  task.rule = *kind;  // the settings of a checked journal name the same
  return rule_of(task);
}

}  // namespace rondure::evaluation
