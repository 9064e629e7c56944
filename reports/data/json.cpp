#include "reports/data/json.h"
#include "reports/data/json_document.h"

namespace rondure::reports {

std::string write_json(const record::RunRecord& record, const evaluation::Evaluation& evaluation) {
  // Names come from plans and command lines: bytes that are not UTF-8 are replaced, not refused.
  return report_document(record, evaluation)
             .dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace rondure::reports
