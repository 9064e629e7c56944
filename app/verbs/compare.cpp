#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "evaluation/evaluation.h"
#include "evaluation/factors/study.h"
#include "plans/checks/record.h"
#include "record/journal/journal.h"
#include "reports/data/factors.h"
#include "reports/terminal/factors.h"

namespace rondure::app {

int compare(const CompareArguments& arguments) {
  const auto read = record::read_journal(arguments.directory);
  if (!read) {
    print_error(read.error());
    return kBadInput;
  }
  const std::vector<std::string> faults = record::faults_of(*read);
  for (const std::string& fault : faults) {
    tell(fmt::format("rondure: {}: {}\n", arguments.directory, fault));
  }
  if (!faults.empty()) return kBadInput;
  if (const auto checked = plans::check_record(read->record); !checked) {
    print_error(checked.error().at(arguments.directory));
    return kBadInput;
  }
  if (read->record.ending != "finished") {
    tell(
        fmt::format("rondure: {}: the run did not finish; its values are void, and what is said of "
                    "them holds for the touches so far\n",
                    arguments.directory));
  }
  const auto evaluation = evaluation::evaluate(read->record);
  if (!evaluation) {
    print_error(evaluation.error());
    return kBadInput;
  }
  const auto comparison = evaluation::compare_run(*evaluation);
  if (!comparison) {
    print_error(comparison.error().at(arguments.directory));
    return kBadInput;
  }
  const std::string& id = read->record.header.run_id;
  say(arguments.json ? reports::comparison_json(id, *comparison)
                     : reports::comparison_text(id, *comparison, arguments.all));
  return kAllWell;
}

}  // namespace rondure::app
