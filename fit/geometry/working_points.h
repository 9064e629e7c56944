#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// The points on which a descent works: relative to an origin, column by column, each with its row
/// in the data. clear() keeps the memory.
template <int D>
class WorkingPoints {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::size_t row(std::size_t i) const { return rows_[i]; }
  [[nodiscard]] const double* column(int k) const {
    return columns_[static_cast<std::size_t>(k)].data();
  }
  [[nodiscard]] Point operator[](std::size_t i) const {
    Point out;
    for (int k = 0; k < D; ++k) out(k) = column(k)[i];
    return out;
  }
  void clear() {
    rows_.clear();
    for (auto& column : columns_) column.clear();
  }
  /// Replaces the contents by all points of a set, relative to the origin.
  void assign(std::span<const Point> points, const Point& origin) {
    rows_.resize(points.size());
    std::iota(rows_.begin(), rows_.end(), std::size_t{0});
    for (auto& column : columns_) column.resize(points.size());
    std::array<double*, D> out;
    for (std::size_t k = 0; k < D; ++k) out[k] = columns_[k].data();
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < D; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        out[k][i] = points[i](at) - origin(at);
      }
    }
  }
  void add(std::size_t row, const Point& point) {
    rows_.push_back(row);
    for (int k = 0; k < D; ++k) columns_[static_cast<std::size_t>(k)].push_back(point(k));
  }

 private:
  std::vector<std::size_t> rows_;
  std::array<std::vector<double>, D> columns_;
};

}  // namespace rondure::fit
