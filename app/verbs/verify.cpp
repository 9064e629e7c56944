#include <fmt/format.h>

#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "record/files.h"
#include "reports/verify/verify.h"

namespace rondure::app {

int verify(const VerifyArguments& arguments) {
  reports::VerifyOptions options = verify_options(arguments.directory);
  if (!arguments.key.empty()) {
    const auto key = record::read_file(arguments.key);
    if (!key) return refuse(key.error());
    options.public_key_pem = *key;
  }
  const auto outcome = reports::verify_run(arguments.directory, options);
  if (!outcome) {
    const bool of_key = outcome.error().code == core::Code::kBadOption;
    return refuse(of_key ? outcome.error().at(arguments.key) : outcome.error());
  }
  for (const std::string& difference : outcome->differences)
    say_line(fmt::format("not equal: {}", difference));
  const bool equal = outcome->differences.empty();
  if (equal) say_line(fmt::format("equal: {}", outcome->what_was_compared));
  for (const std::string& note : outcome->notes) say_line(fmt::format("note: {}", note));
  return equal ? kAllWell : kNotConforming;
}

}  // namespace rondure::app
