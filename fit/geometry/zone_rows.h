#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/column_extremes.h"

namespace rondure::fit {

/// The linearised points of a zone: distance of each point, and its gradient with respect to the K
/// unknowns of the place (2 circle, 3 sphere, 4 cylinder), all in mm. Stored column by column, so
/// that pricing can use vector instructions. clear() keeps the memory.
template <int K>
class ZoneRows {
 public:
  using Gradient = Eigen::Matrix<double, K, 1>;

  [[nodiscard]] std::size_t size() const { return columns_[0].size(); }
  void resize(std::size_t count) {
    for (auto& column : columns_) column.resize(count);
  }
  void clear() { resize(0); }
  void push_back(double distance, const Gradient& gradient) {
    columns_[0].push_back(distance);
    for (int k = 0; k < K; ++k) gradients(k).push_back(gradient(k));
  }
  [[nodiscard]] const std::vector<double>& distances() const { return columns_[0]; }
  [[nodiscard]] std::vector<double>& distances() { return columns_[0]; }
  [[nodiscard]] const std::vector<double>& gradients(int k) const {
    return columns_[static_cast<std::size_t>(k) + 1];
  }
  [[nodiscard]] std::vector<double>& gradients(int k) {
    return columns_[static_cast<std::size_t>(k) + 1];
  }
  [[nodiscard]] Gradient gradient(std::size_t i) const {
    Gradient out;
    for (int k = 0; k < K; ++k) out(k) = gradients(k)[i];
    return out;
  }
  /// Extremes of the linearised distances after a move.
  [[nodiscard]] Extremes moved(const Gradient& step) const {
    Extremes out;
    for (std::size_t i = 0; i < size(); ++i) out.take(distances()[i] + gradient(i).dot(step));
    return out;
  }

 private:
  std::array<std::vector<double>, K + 1> columns_;
};

/// Exact distance of a contact from the reported centre or axis, with first and second derivative.
template <int K>
struct ContactRow {
  std::size_t index = 0;
  double distance = 0.0;
  Eigen::Matrix<double, K, 1> gradient = Eigen::Matrix<double, K, 1>::Zero();
  Eigen::Matrix<double, K, K> hessian = Eigen::Matrix<double, K, K>::Zero();
};

}  // namespace rondure::fit
