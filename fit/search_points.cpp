#include "fit/search_points.h"

#include <cmath>
#include <numbers>

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
  // Multiples of the golden ratio: even over the whole, and in step with no layer or turn.
  for (std::size_t k = 0; k < kSpread; ++k) {
    const double place = static_cast<double>(k) / std::numbers::phi;
    add(static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(count)));
  }
}

bool SearchRows::add(std::size_t row) {
  if (taken_[row]) return false;
  taken_[row] = true;
  rows_.push_back(row);
  return true;
}

}  // namespace rondure::fit
