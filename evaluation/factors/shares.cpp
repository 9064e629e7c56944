#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "evaluation/factors/study.h"

namespace rondure::evaluation {
namespace {

using Levels = std::vector<std::vector<std::size_t>>;

bool in_block(const std::vector<std::size_t>& combination, const Levels& used) {
  for (std::size_t f = 0; f < used.size(); ++f) {
    if (!std::binary_search(used[f].begin(), used[f].end(), combination[f])) return false;
  }
  return true;
}

/// A level with missing values, and their fraction.
struct Lacking {
  std::size_t factor = 0;
  std::size_t level = 0;
  double missing_1 = 0.0;
  std::size_t levels = 0;  ///< Number of levels of its factor.
};

/// Counts of values and of missing values for each level of each factor within the block.
struct Census {
  std::vector<std::vector<std::size_t>> values;
  std::vector<std::vector<std::size_t>> missing;
};

Census census_of(const FactorTable& table, const Levels& used) {
  Census out;
  for (const std::size_t levels : table.levels) {
    out.values.emplace_back(levels, 0);
    out.missing.emplace_back(levels, 0);
  }
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const auto combination = table.combination(i);
    if (!in_block(combination, used)) continue;
    for (std::size_t f = 0; f < combination.size(); ++f) {
      ++out.values[f][combination[f]];
      if (!table.values[i]) ++out.missing[f][combination[f]];
    }
  }
  return out;
}

/// The level to leave out next, or nothing when the block is full.
std::optional<Lacking> worst_level(const FactorTable& table, const Levels& used,
                                   std::span<const std::size_t> reported) {
  const Census census = census_of(table, used);
  std::optional<Lacking> worst;
  for (std::size_t f = 0; f < used.size(); ++f) {
    for (const std::size_t level : used[f]) {
      if (level == reported[f] || census.missing[f][level] == 0) continue;
      const Lacking one{f, level,
                        static_cast<double>(census.missing[f][level]) /
                            static_cast<double>(census.values[f][level]),
                        used[f].size()};
      const bool worse = !worst || one.missing_1 > worst->missing_1 ||
                         (one.missing_1 == worst->missing_1 && one.levels > worst->levels);
      if (worse) worst = one;
    }
  }
  return worst;
}

Levels full_block(const FactorTable& table, std::span<const std::size_t> reported) {
  Levels used;
  for (const std::size_t levels : table.levels) {
    used.emplace_back(levels);
    std::iota(used.back().begin(), used.back().end(), std::size_t{0});
  }
  while (const auto worst = worst_level(table, used, reported))
    std::erase(used[worst->factor], worst->level);
  return used;
}

}  // namespace

std::size_t FactorTable::index(std::span<const std::size_t> combination) const {
  std::size_t out = 0;
  for (std::size_t f = 0; f < levels.size(); ++f) out = out * levels[f] + combination[f];
  return out;
}

std::vector<std::size_t> FactorTable::combination(std::size_t index) const {
  std::vector<std::size_t> out(levels.size(), 0);
  for (std::size_t f = levels.size(); f-- > 0; index /= levels[f]) out[f] = index % levels[f];
  return out;
}

std::optional<FactorShares> factor_shares(const FactorTable& table,
                                          std::span<const std::size_t> reported) {
  assert(table.values[table.index(reported)]);
  FactorShares out;
  out.used = full_block(table, reported);
  std::vector<std::vector<double>> sums;
  for (const std::size_t levels : table.levels) sums.emplace_back(levels, 0.0);
  std::vector<std::vector<std::size_t>> rows;
  std::vector<double> values;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    auto combination = table.combination(i);
    if (!in_block(combination, out.used)) continue;
    values.push_back(*table.values[i]);
    rows.push_back(std::move(combination));
  }
  out.values = values.size();
  const auto n = static_cast<double>(values.size());
  for (const double value : values) out.mean += value / n;
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double apart = values[i] - out.mean;
    squares += apart * apart;
    for (std::size_t f = 0; f < sums.size(); ++f) sums[f][rows[i][f]] += apart;
  }
  out.variance = squares / n;
  if (std::sqrt(out.variance) <= 1e-12 * std::max(1.0, std::abs(out.mean))) return std::nullopt;
  double main_1 = 0.0;
  for (std::size_t f = 0; f < sums.size(); ++f) {
    const double of_level = n / static_cast<double>(out.used[f].size());
    double share = 0.0;
    for (const std::size_t level : out.used[f])
      share += sums[f][level] * sums[f][level] / (of_level * squares);
    out.share_1.push_back(share);
    main_1 += share;
  }
  out.together_1 = std::max(0.0, 1.0 - main_1);
  return out;
}

}  // namespace rondure::evaluation
