#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rondure::record {

/// The first rows of a table without a head line, as far as they have all of its numbers.
struct NumberRows {
  std::vector<std::size_t> places;        ///< Of the columns of numbers in a line, from 0.
  std::vector<std::size_t> decimals;      ///< How many rows have decimals, a column each.
  std::vector<std::vector<double>> rows;  ///< Finite numbers.

  /// Whether the first column is 0, 1, 2, ... or 1, 2, 3, ..., or others without decimals in equal
  /// steps, 10, 20, 30, ..., beside columns with decimals.
  [[nodiscard]] bool counts() const;

  /// Whether the first three columns are x, y and z: more follow that are a direction or, of a
  /// cloud, a colour or an intensity, and the first is no name of the row.
  /// @param cloud  The file is one of points by its ending, as .xyz.
  [[nodiscard]] bool begin_with_points(bool cloud) const;

  /// What is said where columns must be named.
  [[nodiscard]] std::string name_columns() const;

 private:
  [[nodiscard]] bool names_rows_first() const;
};

}  // namespace rondure::record
