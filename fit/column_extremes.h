#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace rondure::fit {

/// Least and largest number of a column.
struct ColumnExtremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

/// Two numbers at a time where the processor can: the compiler must not reorder minima, so it would
/// leave this loop scalar. Numbers that are not a number may or may not take part.
[[nodiscard]] ColumnExtremes column_extremes(std::span<const double> values);

/// Writes  moved = values + sum of gradients[k] * move[k]  and finds its extremes in the same loop.
/// @param gradients  K columns as long as `values`, of which each takes `move[k]`.
template <int K>
ColumnExtremes move_column(std::span<const double> values, const double* const* gradients,
                           const double* move, double* moved);

/// The first row that holds exactly this number; the last row when none does.
[[nodiscard]] std::size_t first_row_of(std::span<const double> values, double value);

extern template ColumnExtremes move_column<1>(std::span<const double>, const double* const*,
                                              const double*, double*);
extern template ColumnExtremes move_column<2>(std::span<const double>, const double* const*,
                                              const double*, double*);
extern template ColumnExtremes move_column<3>(std::span<const double>, const double* const*,
                                              const double*, double*);
extern template ColumnExtremes move_column<4>(std::span<const double>, const double* const*,
                                              const double*, double*);

}  // namespace rondure::fit
