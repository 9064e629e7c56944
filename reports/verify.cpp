#include "reports/verify.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/journal.h"
#include "record/points_csv.h"
#include "reports/compare_text.h"
#include "reports/evaluation.h"
#include "reports/exports.h"

namespace rondure::reports {
namespace {

namespace fs = std::filesystem;

/// Numbers of another kind of processor may differ by this: mm, um or deg alike.
constexpr double kAcrossProcessors = 1e-9;

/// The first stored result that no longer follows, and how many others.
void compare_results(const record::RunRecord& record, const Evaluation& evaluation,
                     double tolerance, Verification& out) {
  std::map<std::string, double> stored;
  for (const auto& result : record.results) stored[result.name] = result.value;
  const auto now = stored_results(evaluation);
  std::size_t others = 0;
  std::string first;
  for (const auto& result : now) {
    const auto found = stored.find(result.name);
    const bool equal = found != stored.end() && std::abs(found->second - result.value) <= tolerance;
    if (found != stored.end()) stored.erase(found->first);
    if (equal) continue;
    if (!first.empty()) {
      ++others;
      continue;
    }
    const auto stored_value = std::find_if(record.results.begin(), record.results.end(),
                                           [&](const auto& r) { return r.name == result.name; });
    first = stored_value == record.results.end()
                ? fmt::format("result {} is not stored; the touches give {}", result.name,
                              core::shortest(result.value))
                : fmt::format("result {} no longer follows: stored {}, the touches give {}",
                              result.name, core::shortest(stored_value->value),
                              core::shortest(result.value));
  }
  if (first.empty() && !stored.empty()) {
    first = fmt::format("stored result {} = {} has no counterpart", stored.begin()->first,
                        core::shortest(stored.begin()->second));
  }
  if (first.empty()) return;
  out.differences.push_back(others == 0 ? first : fmt::format("{} (and {} more)", first, others));
}

std::optional<std::string> compare_export(const Export& what, const std::string& expected,
                                          const std::string& found, double tolerance) {
  if (what.format == "json") return first_json_difference(expected, found, tolerance);
  if (what.format == "csv") return first_csv_difference(expected, found, tolerance);
  return first_text_difference(expected, found, tolerance);
}

/// Compares each export that exists; gives their names.
core::Result<std::string> compare_exports(const fs::path& directory,
                                          const record::RunRecord& record,
                                          const Evaluation& evaluation, double tolerance,
                                          Verification& out) {
  std::string names;
  for (const Export& e : exports()) {
    if (!fs::exists(directory / e.file)) continue;
    const auto bytes = record::read_file(directory / e.file);
    if (!bytes) return core::fail(bytes.error());
    names += (names.empty() ? "" : ", ") + e.file;
    if (const auto difference =
            compare_export(e, render(e, record, evaluation), *bytes, tolerance)) {
      out.differences.push_back(fmt::format("{}: {}", e.file, *difference));
    }
  }
  return names;
}

}  // namespace

core::Result<Verification> verify_run(const fs::path& directory, const std::string& processor) {
  const auto read = record::read_journal(directory);
  if (!read) return core::fail(read.error());
  const record::RunRecord& record = read->record;
  Verification out;
  for (const record::BrokenTable& broken : read->broken) {
    out.differences.push_back(fmt::format("journal, table {}: {}", broken.table, broken.what));
  }
  if (record.ending != "finished") {
    out.differences.push_back(
        fmt::format("the run did not finish ({}); it has no results to verify",
                    record.ending.empty() ? "it was interrupted" : record.ending));
  } else if (!record.sealed) {
    out.differences.push_back(
        "the journal was not closed: the run was interrupted after its last touch");
  }
  const auto evaluation = evaluate(record);
  if (!evaluation) return core::fail(evaluation.error());
  const bool same = record.header.processor == processor;
  const double tolerance = same ? 0.0 : kAcrossProcessors;
  if (record.sealed) compare_results(record, *evaluation, tolerance, out);
  const auto names = compare_exports(directory, record, *evaluation, tolerance, out);
  if (!names) return core::fail(names.error());
  out.what_was_compared =
      fmt::format("{} touches, {} results{}{} follow from the journal, {}", record.touches.size(),
                  record.results.size(), names->empty() ? "" : ", ", *names,
                  same ? "bit for bit (same kind of processor)"
                       : fmt::format("numbers within 1e-9 (measured on {}, verified on {})",
                                     record.header.processor, processor));
  return out;
}

}  // namespace rondure::reports
