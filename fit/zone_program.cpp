#include "fit/zone_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

namespace rondure::fit {
namespace {

constexpr int kDantzigPivots = 300;
constexpr int kPivotLimit = 5000;

/// A column of the dual programme. Order of the kinds is Bland's order.
struct Column {
  enum class Kind { kOuter, kInner, kBoxUp, kBoxDown };
  Kind kind = Kind::kOuter;
  std::size_t index = 0;  ///< Row of the point, or number of the unknown.

  friend auto operator<=>(const Column&, const Column&) = default;
};

template <int K>
class DualSimplexTable {
  static constexpr int kRows = K + 2;
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Unknowns = Eigen::Matrix<double, K, 1>;

 public:
  DualSimplexTable(std::span<const ZoneRow<K>> rows, double box_mm) : rows_(rows), box_(box_mm) {
    start_basis();
  }

  ZoneStep<K> solve() {
    ZoneStep<K> out;
    for (; out.pivots < kPivotLimit; ++out.pivots) {
      factorise();
      const auto entering = price(out.pivots >= kDantzigPivots);
      if (!entering || !pivot(*entering)) {
        out.solved = true;
        break;
      }
    }
    report(out);
    return out;
  }

 private:
  void start_basis() {
    std::size_t far = 0;
    std::size_t near = 0;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (rows_[i].distance > rows_[far].distance) far = i;
      if (rows_[i].distance < rows_[near].distance) near = i;
    }
    const double spread = rows_[far].distance - rows_[near].distance;
    // Violations below this are round-off of the distances; they are not worth a pivot.
    tolerance_ = 1e-13 * spread +
                 4.0 * std::numeric_limits<double>::epsilon() * std::abs(rows_[far].distance);
    basis_[0] = {Column::Kind::kOuter, far};
    basis_[1] = {Column::Kind::kInner, near};
    // The box takes up whatever the two points do not balance.
    const Unknowns rest = rows_[far].gradient - rows_[near].gradient;
    for (int k = 0; k < K; ++k) {
      basis_[static_cast<std::size_t>(k) + 2] = {
          rest(k) > 0.0 ? Column::Kind::kBoxDown : Column::Kind::kBoxUp,
          static_cast<std::size_t>(k)};
    }
  }

  [[nodiscard]] Vector column(const Column& c) const {
    Vector a = Vector::Zero();
    switch (c.kind) {
      case Column::Kind::kOuter:
        a(0) = 1.0;
        a.template tail<K>() = rows_[c.index].gradient;
        break;
      case Column::Kind::kInner:
        a(1) = 1.0;
        a.template tail<K>() = -rows_[c.index].gradient;
        break;
      case Column::Kind::kBoxUp:
        a(static_cast<Eigen::Index>(c.index) + 2) = 1.0;
        break;
      case Column::Kind::kBoxDown:
        a(static_cast<Eigen::Index>(c.index) + 2) = -1.0;
        break;
    }
    return a;
  }

  [[nodiscard]] double cost(const Column& c) const {
    switch (c.kind) {
      case Column::Kind::kOuter:
        return rows_[c.index].distance;
      case Column::Kind::kInner:
        return -rows_[c.index].distance;
      default:
        return -box_;
    }
  }

  void factorise() {
    Eigen::Matrix<double, kRows, kRows> basis;
    Vector costs;
    for (int k = 0; k < kRows; ++k) {
      basis.col(k) = column(basis_[static_cast<std::size_t>(k)]);
      costs(k) = cost(basis_[static_cast<std::size_t>(k)]);
    }
    factor_.compute(basis);
    Vector right = Vector::Zero();
    right(0) = right(1) = 1.0;
    values_ = factor_.solve(right);
    prices_ = factor_.transpose().solve(costs);
  }

  /// The column that violates its constraint most (or, Bland, the first that does).
  [[nodiscard]] std::optional<Column> price(bool bland) const {
    const double outer = prices_(0);
    const double inner = -prices_(1);
    const Unknowns move = -prices_.template tail<K>();
    double worst = tolerance_;
    std::optional<Column> entering;
    const auto offer = [&](double violation, Column::Kind kind, std::size_t index) {
      if (violation <= worst) return;
      const Column candidate{kind, index};
      if (bland && entering && *entering < candidate) return;
      if (!bland) worst = violation;
      entering = candidate;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double moved = rows_[i].distance + rows_[i].gradient.dot(move);
      offer(moved - outer, Column::Kind::kOuter, i);
      offer(inner - moved, Column::Kind::kInner, i);
    }
    for (std::size_t k = 0; k < K; ++k) {
      offer(move(static_cast<Eigen::Index>(k)) - box_, Column::Kind::kBoxUp, k);
      offer(-box_ - move(static_cast<Eigen::Index>(k)), Column::Kind::kBoxDown, k);
    }
    return entering;
  }

  /// Exchanges the entering column; false when no basic column limits it (never: the box bounds).
  bool pivot(const Column& entering) {
    const Vector direction = factor_.solve(column(entering));
    int leaving = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kRows; ++k) {
      if (direction(k) <= 1e-11) continue;
      const double ratio = std::max(values_(k), 0.0) / direction(k);
      // Among equal ratios the larger pivot is the safer one.
      const bool tie = leaving >= 0 && std::abs(ratio - least) <= 1e-14;
      if ((!tie && ratio < least) || (tie && direction(k) > direction(leaving))) {
        leaving = k;
        least = std::min(least, ratio);
      }
    }
    if (leaving < 0) return false;
    basis_[static_cast<std::size_t>(leaving)] = entering;
    return true;
  }

  void report(ZoneStep<K>& out) const {
    out.step = -prices_.template tail<K>();
    out.width = prices_(0) + prices_(1);
    out.inside_box = true;
    for (int k = 0; k < kRows; ++k) {
      const Column& c = basis_[static_cast<std::size_t>(k)];
      const double value = values_(k);
      const bool point = c.kind == Column::Kind::kOuter || c.kind == Column::Kind::kInner;
      if (!point) {
        if (value > 1e-9) out.inside_box = false;
        continue;
      }
      if (value <= 0.0) continue;
      (c.kind == Column::Kind::kOuter ? out.outer : out.inner).push_back({c.index, value});
    }
    const auto by_index = [](const Contact& a, const Contact& b) { return a.index < b.index; };
    std::sort(out.outer.begin(), out.outer.end(), by_index);
    std::sort(out.inner.begin(), out.inner.end(), by_index);
  }

  std::span<const ZoneRow<K>> rows_;
  double box_;
  double tolerance_ = 0.0;
  std::array<Column, kRows> basis_;
  Eigen::PartialPivLU<Eigen::Matrix<double, kRows, kRows>> factor_;
  Vector values_ = Vector::Zero();
  Vector prices_ = Vector::Zero();
};

}  // namespace

template <int K>
ZoneStep<K> solve_zone_program(std::span<const ZoneRow<K>> rows, double box_mm) {
  return DualSimplexTable<K>(rows, box_mm).solve();
}

template ZoneStep<1> solve_zone_program<1>(std::span<const ZoneRow<1>>, double);
template ZoneStep<2> solve_zone_program<2>(std::span<const ZoneRow<2>>, double);
template ZoneStep<3> solve_zone_program<3>(std::span<const ZoneRow<3>>, double);
template ZoneStep<4> solve_zone_program<4>(std::span<const ZoneRow<4>>, double);

}  // namespace rondure::fit
