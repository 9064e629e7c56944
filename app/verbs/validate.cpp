#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "plans/forecast/forecast.h"
#include "plans/plan.h"

namespace rondure::app {

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
  return kAllWell;
}

}  // namespace rondure::app
