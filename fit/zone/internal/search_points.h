#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// The rows that a proof uses: the contacts and some sixty more, spread over the data so that they
/// do not coincide with a period of the scan; all rows of a small set. The zone of some points is a
/// lower bound for the zone of all, so a bound for these rows holds for the data.
class SearchRows {
 public:
  SearchRows(std::size_t count, std::span<const Contact> outer, std::span<const Contact> inner);

  [[nodiscard]] const std::vector<std::size_t>& rows() const { return rows_; }
  /// Adds a row.
  /// @return Whether it was not yet included.
  bool add(std::size_t row);

 private:
  std::vector<bool> taken_;
  std::vector<std::size_t> rows_;
};

/// The farthest and the nearest of some points, and the value of their zone.
struct ExtremeRows {
  std::size_t far = 0;
  std::size_t near = 0;
  double value = 0.0;
};

/// @param square  Squared distance of a point from the centre or axis.
template <class Points, class Square>
[[nodiscard]] ExtremeRows extreme_rows(const Points& points, const Square& square,
                                       const ZoneWeights& weights) {
  ExtremeRows out;
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double here = square(points[i]);
    if (here > high) {
      high = here;
      out.far = i;
    }
    if (here < low) {
      low = here;
      out.near = i;
    }
  }
  out.value = weights.value({std::sqrt(low), std::sqrt(high)});
  return out;
}

/// States why a search that reached its limit proves nothing: "12 squares of centres were left
/// after 40; lower bound 0.0123 mm, 0.0001 mm from the value found".
[[nodiscard]] core::Phrase left_open(std::string_view boxes, std::size_t left, int after,
                                     double lower_mm, double value_mm, const ZoneWeights& weights);

}  // namespace rondure::fit
