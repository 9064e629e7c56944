#include "reports/verify/internal/results.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::reports {
namespace {

/// One result by its name: as stored, and as the touches give it now.
struct Pair {
  std::optional<double> stored;
  std::optional<double> now;
};

/// What is wrong with one result, or nothing.
std::optional<std::string> compare(const std::string& name, const Pair& pair,
                                   const Exactness& exactness) {
  if (!pair.stored || !pair.now) {
    if (!exactness.same_version) return std::nullopt;
    return pair.now ? fmt::format("result {} is not stored; the touches give {}", name,
                                  core::shortest(*pair.now))
                    : fmt::format("stored result {} = {} has no counterpart", name,
                                  core::shortest(*pair.stored));
  }
  if (*pair.stored == *pair.now || std::abs(*pair.stored - *pair.now) <= exactness.tolerance()) {
    return std::nullopt;
  }
  return fmt::format("result {} no longer follows: stored {}, the touches give {}", name,
                     core::shortest(*pair.stored), core::shortest(*pair.now));
}

}  // namespace

ResultComparison compare_results(const std::vector<record::StoredResult>& stored,
                                 const std::vector<record::StoredResult>& now,
                                 const Exactness& exactness) {
  std::map<std::string, Pair> pairs;
  std::vector<std::string> order;  // of the report, so that the first difference is the highest
  const auto pair_of = [&](const std::string& name) -> Pair& {
    if (!pairs.contains(name)) order.push_back(name);
    return pairs[name];
  };
  for (const record::StoredResult& result : now) pair_of(result.name).now = result.value;
  for (const record::StoredResult& result : stored) pair_of(result.name).stored = result.value;
  ResultComparison out;
  std::size_t differences = 0;
  for (const std::string& name : order) {
    const Pair& pair = pairs[name];
    out.results += pair.stored && pair.now ? 1 : 0;
    auto difference = compare(name, pair, exactness);
    if (difference && ++differences == 1) out.difference = std::move(difference);
  }
  if (differences > 1) *out.difference += fmt::format(" (and {} more)", differences - 1);
  return out;
}

}  // namespace rondure::reports
