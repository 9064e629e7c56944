#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/terminal.h"
#include "app/verbs.h"
#include "plans/record_check.h"
#include "record/journal.h"
#include "reports/evaluation.h"
#include "reports/factor_json.h"
#include "reports/factor_study.h"
#include "reports/factor_text.h"

namespace rondure::app {

int compare(const CompareArguments& arguments) {
  const auto read = record::read_journal(arguments.directory);
  if (!read) {
    complain(read.error());
    return kBadInput;
  }
  const std::vector<std::string> faults = record::faults_of(*read);
  for (const std::string& fault : faults) {
    tell(fmt::format("rondure: {}: {}\n", arguments.directory, fault));
  }
  if (!faults.empty()) return kBadInput;
  if (const auto checked = plans::check_record(read->record); !checked) {
    complain(checked.error().at(arguments.directory));
    return kBadInput;
  }
  if (read->record.ending != "finished") {
    tell(
        fmt::format("rondure: {}: the run did not finish; its values are void, and what is said of "
                    "them holds for the touches so far\n",
                    arguments.directory));
  }
  const auto evaluation = reports::evaluate(read->record);
  if (!evaluation) {
    complain(evaluation.error());
    return kBadInput;
  }
  const auto comparison = reports::compare_run(*evaluation);
  if (!comparison) {
    complain(comparison.error().at(arguments.directory));
    return kBadInput;
  }
  const std::string& id = read->record.header.run_id;
  say(arguments.json ? reports::comparison_json(id, *comparison)
                     : reports::comparison_text(id, *comparison, arguments.all));
  return kAllWell;
}

}  // namespace rondure::app
