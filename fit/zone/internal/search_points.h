#pragma once

#include <cstddef>
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

/// States why a search that reached its limit proves nothing: "12 squares of centres were left
/// after 40; lower bound 0.0123 mm, 0.0001 mm from the value found".
[[nodiscard]] core::Phrase left_open(std::string_view boxes, std::size_t left, int after,
                                     double lower_mm, double value_mm, const ZoneWeights& weights);

}  // namespace rondure::fit
