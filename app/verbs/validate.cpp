#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
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
  say_line(fmt::format("{}: valid; {} {}, {} feature{}", arguments.plan, plan->plan.name,
                       plan->plan.revision, plan->features.size(),
                       plan->features.size() == 1 ? "" : "s"));
  return kAllWell;
}

}  // namespace rondure::app
