#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/text/forecast.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "evaluation/prediction/predict.h"
#include "plans/analyses/features.h"
#include "plans/checks/doubts.h"
#include "plans/checks/points_file.h"
#include "plans/forecast/forecast.h"
#include "plans/plan.h"
#include "record/files.h"
#include "record/points/points.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::app {
namespace {

/// Visitor: the keys of the influences that an analysis leaves out.
struct LeftOutKeys {
  std::vector<std::string> names = {};

  template <class Spec>
  void influence(std::string_view key, const record::Influence& said, const Spec&) {
    if (!said) names.emplace_back(key);
  }
};

void say_undeclared(const std::string& of, const std::vector<std::string>& names) {
  if (names.empty()) return;
  say_line(fmt::format("{}: not declared, so in no interval: {}", of, fmt::join(names, ", ")));
}

template <class Task>
void say_undeclared(const std::string& id, const std::optional<Task>& task) {
  if (!task) return;
  if (!task->uncertainty) {
    say_line(fmt::format("feature {}: no influences are declared", id));
    return;
  }
  LeftOutKeys keys;
  auto said = *task->uncertainty;
  describe(keys, said);
  say_undeclared(fmt::format("feature {}", id), keys.names);
}

/// What the plan leaves undeclared is in no interval.
void say_undeclared(const plans::Plan& plan) {
  bool surfaces = false;
  bool repeated = false;
  for (const plans::FeaturePlan& feature : plan.features) {
    say_undeclared(feature.id, feature.spindle);
    say_undeclared(feature.id, feature.wheel);
    say_undeclared(feature.id, feature.contour);
    say_undeclared(feature.id, feature.rotary_axes);
    surfaces = surfaces || !record::is_analysis(feature.type);
    repeated = repeated || (plans::is_touched(feature) && feature.pose_search.repeats > 1);
  }
  if (!surfaces) return;
  if (!plan.uncertainty) return say_line("uncertainty: not declared, no value has an interval");
  auto names =
      evaluation::undeclared_influences(*plan.uncertainty, plan.part.expansion_per_K, repeated);
  if (!plan.fixture || plans::is_fixed(plan)) {  // as the run, which says nothing of a fixture then
    std::erase_if(names, [](const std::string& name) { return name.starts_with("fixture-"); });
  }
  say_undeclared("uncertainty", names);
}

}  // namespace

namespace {

/// What the reader of points took for what; the plan is valid, so that it reads every file.
void say_what_was_read(const plans::Plan& plan) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const plans::FeaturePlan& feature = plan.features[i];
    if (!feature.source || record::is_analysis(feature.type)) continue;
    const auto bytes =
        record::read_file(plan.folder / feature.source->file, record::kMostPointsBytes);
    if (!bytes) continue;
    const auto table = plans::points_of(plan, i, *bytes);
    if (table && !table->read.empty())
      say_line(fmt::format("feature {}: {}: {}", feature.id, feature.source->file, table->read));
  }
}

}  // namespace

void tell_doubts(const std::vector<core::Error>& doubts) {
  for (const core::Error& doubt : doubts) {
    tell(fmt::format("rondure: please check {}: {}\n", doubt.where, doubt.what));
  }
}

int validate(const ValidateArguments& arguments) {
  const auto plan = plans::read_plan(arguments.plan);
  if (!plan) {
    print_error(plan.error());
    tell(fmt::format("{}: {} problem{}\n", arguments.plan, plan.error().size(),
                     plan.error().size() == 1 ? "" : "s"));
    return kBadInput;
  }
  // The reach of every pose that a run would take, as run and plan check it.
  if (const auto reached = plans::forecast(*plan); !reached) {
    print_error(reached.error());
    tell(fmt::format("{}: 1 problem\n", arguments.plan));
    return kBadInput;
  }
  say_line(fmt::format("{}: valid; {} {}, {} feature{}", arguments.plan, plan->plan.name,
                       plan->plan.revision, plan->features.size(),
                       plan->features.size() == 1 ? "" : "s"));
  say_what_was_read(*plan);
  say_undeclared(*plan);
  say(holder_line(*plan));
  tell_doubts(plans::doubts_of(*plan));
  return kAllWell;
}

}  // namespace rondure::app
