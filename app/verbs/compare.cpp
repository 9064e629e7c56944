#include <string>

#include <fmt/format.h>

#include "app/run/ending.h"
#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "evaluation/factors/study.h"
#include "reports/data/factors.h"
#include "reports/terminal/factors.h"

namespace rondure::app {

int compare(const CompareArguments& arguments) {
  const auto record = read_sound_record(arguments.directory);
  if (!record) return kBadInput;
  if (record->ending != "finished") {
    tell(
        fmt::format("rondure: {}: the run did not finish; its values are void, and what is said of "
                    "them holds for the touches so far\n",
                    arguments.directory));
  }
  const auto evaluation = KeptTrials(arguments.directory).evaluate(*record);
  if (!evaluation) return refuse(evaluation.error());
  const auto comparison = evaluation::compare_run(*evaluation);
  if (!comparison) return refuse(comparison.error().at(arguments.directory));
  const std::string& id = record->header.run_id;
  say(arguments.json ? reports::comparison_json(id, *comparison)
                     : reports::comparison_text(id, *comparison, arguments.all));
  return kAllWell;
}

}  // namespace rondure::app
