#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/contacts.h"
#include "fit/geometry/zone_rows.h"

namespace rondure::fit {

/// Weights of the objective to be minimised,  outer * max_i r_i - inner * min_i r_i.
struct ZoneWeights {
  double outer = 1.0;
  double inner = 1.0;

  [[nodiscard]] double value(const Extremes& zone) const {
    return outer * zone.high - inner * zone.low;
  }
};
inline constexpr ZoneWeights kMinimumZone{1.0, 1.0};
inline constexpr ZoneWeights kMinimumCircumscribed{1.0, 0.0};
inline constexpr ZoneWeights kMaximumInscribed{0.0, 1.0};

/// Solution of the linearised zone.
template <int K>
struct ZoneStep {
  Eigen::Matrix<double, K, 1> step = Eigen::Matrix<double, K, 1>::Zero();  ///< The move d [mm].
  double value = 0.0;  ///< Value that the linearisation predicts after the move [mm].
  Contacts outer;      ///< Rows of the binding points, with their multipliers (> 0).
  Contacts inner;
  bool inside_box = false;  ///< No side of the box binds.
  bool solved = false;      ///< false: the pivot limit ended the programme.
  int pivots = 0;
};

inline constexpr int kZonePivotLimit = 5000;
inline constexpr int kBoundPivotLimit = 60;  ///< Limit for linear programs that only give a bound.

/// Minimises  outer * max_i (r_i + J_i d) - inner * min_i (r_i + J_i d)  over |d_k| <= box.
///
/// Revised primal simplex on the dual programme, which has K + 2 rows, and a column for each point
/// on each side and for each side of the box, which makes the first basis feasible. Pivots follow
/// Dantzig's rule, after 300 pivots Bland's. The inverse of the basis, at most 6 x 6, is updated at
/// each pivot and computed anew if a check at the end finds it inaccurate.
///
/// An object keeps its memory, and its last basis as the start of a programme whose points moved a
/// little. Cost: O(n K) per pivot, commonly 5 to 20 pivots.
/// Source: methods, cylindricity sections 9.3, 11.2 (the box is its trust region) and 11.4.
template <int K>
class ZoneSimplex {
 public:
  /// @param rows  At least one point. If both weights are equal, a common value may be subtracted
  ///              from the distances; otherwise `value` is then off by weight * that value.
  /// @param box_mm  > 0: half side of the box, the trust region.
  /// @param pivot_limit  Most pivots. For a mere bound a low limit is enough, even in a degenerate
  ///                     programme: the multipliers of any basis are valid.
  /// @return `solved` is false if the pivot limit ended the programme.
  ZoneStep<K> solve(const ZoneRows<K>& rows, double box_mm, const ZoneWeights& weights,
                    int pivot_limit = kZonePivotLimit);
  /// The same, from the basis of the last call.
  /// @pre `rows` holds the points of the last call in the same order.
  ZoneStep<K> solve_again(const ZoneRows<K>& rows, double box_mm, const ZoneWeights& weights,
                          int pivot_limit = kZonePivotLimit);

 private:
  static constexpr int kRows = K + 2;
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Square = Eigen::Matrix<double, kRows, kRows>;
  using Unknowns = Eigen::Matrix<double, K, 1>;

  /// A column of the dual programme. Order of the kinds is Bland's order.
  struct Column {
    enum class Kind { kOuter, kInner, kBoxUp, kBoxDown };
    Kind kind = Kind::kOuter;
    std::size_t index = 0;  ///< Row of the point, or number of the unknown.

    friend auto operator<=>(const Column&, const Column&) = default;
  };
  struct Entering {
    Column column;
    bool found = false;
  };

  void set(const ZoneRows<K>& rows, double box_mm, const ZoneWeights& weights);
  void start_basis();
  void put(int place, const Column& c);
  [[nodiscard]] Vector in_basis(const Column& c) const;
  bool factorise();
  ZoneStep<K> run(int pivot_limit);
  ZoneStep<K> attempt(int pivot_limit, int swift);
  [[nodiscard]] bool solves_basis() const;
  [[nodiscard]] Vector value_residual() const;
  [[nodiscard]] Vector price_residual() const;
  void settle_prices();
  bool needs_refactorization();
  Entering price(bool bland);
  bool pivot(const Column& entering);
  void report(ZoneStep<K>& out) const;

  const ZoneRows<K>* rows_ = nullptr;
  std::array<const double*, K> gradients_{};  ///< Columns of the rows.
  double box_ = 0.0;
  ZoneWeights weights_;
  double tolerance_ = 0.0;
  std::array<Column, kRows> basis_{};
  Square columns_ = Square::Identity();  ///< Columns of the basis.
  Vector costs_ = Vector::Zero();        ///< Costs of the basis.
  Square inverse_ = Square::Identity();  ///< Inverse of columns_.
  Vector values_ = Vector::Zero();       ///< Multipliers of the basic columns.
  Vector prices_ = Vector::Zero();
  double value_flaw_ = 0.0;  ///< Largest residual of the multipliers before the last refinement.
  double price_flaw_ = 0.0;
  std::vector<double> moved_;  ///< Distances of all points at the current prices.
};

/// Solves a single programme.
template <int K>
[[nodiscard]] ZoneStep<K> solve_zone_program(const ZoneRows<K>& rows, double box_mm,
                                             const ZoneWeights& weights = kMinimumZone,
                                             int pivot_limit = kZonePivotLimit) {
  return ZoneSimplex<K>().solve(rows, box_mm, weights, pivot_limit);
}

}  // namespace rondure::fit
