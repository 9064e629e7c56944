#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>

namespace rondure::fit {

/// Least and largest of some numbers; (infinity, -infinity) for none.
struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double width() const { return high - low; }
};

/// Finds the extremes of a measure, a function or a member, over the elements of a range.
template <class Range, class Measure>
[[nodiscard]] Extremes extremes_of(const Range& range, const Measure& measure) {
  Extremes out;
  for (const auto& element : range) out.take(std::invoke(measure, element));
  return out;
}

/// Finds the extremes of a column, two numbers at a time if the processor can. The compiler may not
/// reorder minima, so that a plain loop would stay scalar.
[[nodiscard]] Extremes column_extremes(std::span<const double> values);

/// Returns the largest absolute value; not finite if any number is not.
[[nodiscard]] double largest_magnitude(std::span<const double> values);

/// Writes  moved = values + sum of gradients[k] * move[k]  and finds its extremes in the same loop.
/// @param gradients  K columns as long as `values`; column k is multiplied by `move[k]`.
template <int K>
Extremes move_column(std::span<const double> values, const double* const* gradients,
                     const double* move, double* moved);

/// Writes the squared distances from a centre of points given as D columns, and finds their
/// extremes in the same loop.
template <int D>
Extremes square_column(std::size_t count, const double* const* columns, const double* center,
                       double* squares);

/// Returns the first row that holds exactly this number, or the last row if none does.
[[nodiscard]] std::size_t first_row_of(std::span<const double> values, double value);

}  // namespace rondure::fit
