#include "fit/zone/internal/search_points.h"

#include <fmt/format.h>

#include "fit/geometry/points.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kSpread = 60;

}  // namespace

SearchRows::SearchRows(std::size_t count, std::span<const Contact> outer,
                       std::span<const Contact> inner)
    : taken_(count, false) {
  for (const Contact& c : outer) add(c.index);
  for (const Contact& c : inner) add(c.index);
  if (count <= kSpread + 4) {
    for (std::size_t i = 0; i < count; ++i) add(i);
    return;
  }
  for (std::size_t k = 0; k < kSpread; ++k) add(spread_row(k, count));
}

bool SearchRows::add(std::size_t row) {
  if (taken_[row]) return false;
  taken_[row] = true;
  rows_.push_back(row);
  return true;
}

core::Phrase left_open(std::string_view boxes, std::size_t left, int after, double lower_mm,
                       double value_mm, const ZoneWeights& weights) {
  const bool inside = weights.outer == 0.0;
  return core::Phrase(fmt::format(
      "{} {} were left after {}; {} bound {:.9g} mm, {:.3g} mm from the value found", left, boxes,
      after, inside ? "upper" : "lower", inside ? -lower_mm : lower_mm, value_mm - lower_mm));
}

}  // namespace rondure::fit
