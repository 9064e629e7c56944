#include "record/points/internal/number_rows.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Core>

namespace rondure::record {
namespace {

bool is_direction(const Eigen::Vector3d& values) {
  constexpr double kRounding = 2e-3;  // of three decimals, in the square
  return std::abs(values.squaredNorm() - 1.0) <= kRounding;
}

bool is_colour(const Eigen::Vector3d& values) {
  const bool whole = values == values.array().round().matrix();
  return values.minCoeff() >= 0.0 && values.maxCoeff() <= (whole ? 255.0 : 1.0);
}

/// Whether three columns, from one on, are all of a kind.
template <class Kind>
bool are(const NumberRows& table, std::size_t from, const Kind& kind) {
  return std::ranges::all_of(table.rows, [&](const std::vector<double>& row) {
    return kind(Eigen::Vector3d(row[from], row[from + 1], row[from + 2]));
  });
}

/// Whether a column rises, or falls, from each row to the next.
bool is_monotone(const NumberRows& table, std::size_t column) {
  const auto& rows = table.rows;
  const bool rises = rows.front()[column] < rows.back()[column];
  return std::ranges::adjacent_find(rows, [&](const auto& a, const auto& b) {
           return rises ? a[column] >= b[column] : a[column] <= b[column];
         }) == rows.end();
}

}  // namespace

bool NumberRows::counts() const {
  if (rows.size() < 3) return false;
  const double step = rows[1][0] - rows[0][0];
  const bool whole = decimals[0] == 0 && rows[0][0] >= 0.0 &&
                     std::ranges::any_of(decimals, [](std::size_t count) { return count > 0; });
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (step <= 0.0 || rows[k][0] != rows[k - 1][0] + step) return false;
  }
  return whole || (step == 1.0 && (rows[0][0] == 0.0 || rows[0][0] == 1.0));
}

bool NumberRows::names_rows_first() const {
  if (places.size() < 4 || rows.size() < 3) return false;
  const bool others = decimals[1] > 0 && decimals[2] > 0 && decimals[3] > 0;
  return others && (decimals[0] == 0 || (places.size() == 4 && is_monotone(*this, 0)));
}

bool NumberRows::begin_with_points(bool cloud) const {
  const std::size_t count = places.size();
  if (count <= 3) return true;
  if (count == 6 && are(*this, 3, is_direction)) {
    // without a decimal point, commas may be decimal signs
    return cloud || std::ranges::any_of(decimals, [](std::size_t rows_of) { return rows_of > 0; });
  }
  if (!cloud || names_rows_first()) return false;
  const auto follows = [&](std::size_t from) {
    return are(*this, from, is_direction) || are(*this, from, is_colour);
  };
  // six may be nominal and actual points, nine the corners of a facet
  return count == 6 ? follows(3) : count != 9 || follows(3) || follows(6);
}

std::string NumberRows::name_columns() const {
  const bool first = counts() || names_rows_first();
  std::string list;
  for (std::size_t k = first ? 1 : 0; k < std::min<std::size_t>(places.size(), first ? 4 : 3);
       ++k) {
    list += fmt::format("{}{}", list.empty() ? ": --columns " : ",", places[k] + 1);
  }
  return fmt::format("name the columns of x, y and z, counted from 1{}, in a plan source.columns",
                     list);
}

}  // namespace rondure::record
