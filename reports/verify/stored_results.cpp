#include "reports/verify/stored_results.h"

#include <string>

#include "reports/data/internal/json_parts.h"
#include "reports/data/writers.h"

namespace rondure::reports {
namespace {

/// Collects every number below `node` with its JSON pointer. The cloud is left out: it repeats the
/// touches, which the journal's digests cover, and it may have a million rows. The curves of an
/// analysis and the generatrices of a surface are left out too: they follow from series and
/// touches, and report.json holds them.
void collect(const Json& node, const std::string& pointer, std::vector<record::StoredResult>& out) {
  if (node.is_number()) {
    out.push_back({pointer, node.get<double>()});
    return;
  }
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) {
      if (key != "cloud" && key != "curves" && key != "lines")
        collect(value, pointer + "/" + key, out);
    }
  }
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i)
      collect(node[i], pointer + "/" + std::to_string(i), out);
  }
}

}  // namespace

std::vector<record::StoredResult> stored_results(const evaluation::Evaluation& evaluation) {
  const Json document = report_document(record::RunRecord{}, evaluation);
  std::vector<record::StoredResult> out;
  for (const char* part : {"probe", "features"})
    collect(document.at(part), std::string("/") + part, out);
  return out;
}

}  // namespace rondure::reports
