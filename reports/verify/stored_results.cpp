#include "reports/verify/stored_results.h"

#include <string>

#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

/// Collects every number below `node` with its JSON pointer. The curves of an analysis and the
/// generatrices of a surface are left out: they follow from series and touches, and report.json
/// holds them.
void collect(const Json& node, const std::string& pointer, std::vector<record::StoredResult>& out) {
  if (node.is_number()) {
    out.push_back({pointer, node.get<double>()});
    return;
  }
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) {
      if (key != "curves" && key != "lines") collect(value, pointer + "/" + key, out);
    }
  }
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i)
      collect(node[i], pointer + "/" + std::to_string(i), out);
  }
}

}  // namespace

std::vector<record::StoredResult> stored_results(const evaluation::Evaluation& evaluation) {
  // The cloud repeats the touches, which the journal's digests cover.
  std::vector<record::StoredResult> out;
  collect(results_json(evaluation), "", out);
  return out;
}

}  // namespace rondure::reports
