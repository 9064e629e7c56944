#include <fmt/format.h>

#include "app/processor.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "reports/verify.h"

namespace rondure::app {

int verify(const VerifyArguments& arguments) {
  const auto outcome = reports::verify_run(arguments.directory, processor());
  if (!outcome) {
    complain(outcome.error());
    return kBadInput;
  }
  for (const std::string& difference : outcome->differences)
    say(fmt::format("not equal: {}\n", difference));
  if (!outcome->differences.empty()) return kNotConforming;
  say(fmt::format("equal: {}\n", outcome->what_was_compared));
  return kAllWell;
}

}  // namespace rondure::app
