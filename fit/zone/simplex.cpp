#include "fit/zone/simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

constexpr int kDantzigPivots = 300;
/// More pivots than this indicate near ties: every further basis is factorised and refined.
constexpr int kSwiftPivots = 40;
constexpr double kEps = std::numeric_limits<double>::epsilon();
/// Multipliers with a larger error are computed from a fresh factorisation.
constexpr double kWorn = 1e-13;
/// Smaller pivots would make the basis nearly singular.
constexpr double kPivot = 1e-11;
/// Residuals above this indicate that a basis was nearly singular.
constexpr double kSound = 1e-9;

/// Inverts by Gauss-Jordan with row exchanges: up to 6 x 6 several times faster than a general
/// inverse; the caller checks the residuals.
/// @return Whether there is an inverse.
template <int N>
bool invert(Eigen::Matrix<double, N, N> a, Eigen::Matrix<double, N, N>& inverse) {
  Eigen::Matrix<double, N, N> out = Eigen::Matrix<double, N, N>::Identity();
  for (int k = 0; k < N; ++k) {
    int best = k;
    for (int i = k + 1; i < N; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(best, k))) best = i;
    }
    if (!(std::abs(a(best, k)) > 0.0)) return false;
    if (best != k) {
      a.row(k).swap(a.row(best));
      out.row(k).swap(out.row(best));
    }
    const double scale = 1.0 / a(k, k);
    a.row(k) *= scale;
    out.row(k) *= scale;
    for (int i = 0; i < N; ++i) {
      if (i == k) continue;
      const double factor = a(i, k);
      a.row(i) -= factor * a.row(k);
      out.row(i) -= factor * out.row(k);
    }
  }
  if (!out.allFinite()) return false;
  inverse = out;
  return true;
}

}  // namespace

template <int K>
ZoneStep<K> ZoneSimplex<K>::solve(const ZoneRows<K>& rows, double box_mm,
                                  const ZoneWeights& weights, int pivot_limit) {
  set(rows, box_mm, weights);
  start_basis();
  return run(pivot_limit);
}

template <int K>
ZoneStep<K> ZoneSimplex<K>::solve_again(const ZoneRows<K>& rows, double box_mm,
                                        const ZoneWeights& weights, int pivot_limit) {
  set(rows, box_mm, weights);
  for (int k = 0; k < kRows; ++k) put(k, basis_[static_cast<std::size_t>(k)]);
  if (!factorise() || values_.minCoeff() < 0.0) start_basis();
  return run(pivot_limit);
}

template <int K>
void ZoneSimplex<K>::set(const ZoneRows<K>& rows, double box_mm, const ZoneWeights& weights) {
  rows_ = &rows;
  box_ = box_mm;
  weights_ = weights;
  moved_.resize(rows.size());
  for (int k = 0; k < K; ++k) gradients_[static_cast<std::size_t>(k)] = rows.gradients(k).data();
}

template <int K>
void ZoneSimplex<K>::start_basis() {
  const std::vector<double>& distances = rows_->distances();
  const Extremes extremes = column_extremes(distances);
  // Violations below this are round-off of the distances, or of moves as long as the box, and do
  // not justify a pivot: the basis would go round in a ring of such columns.
  tolerance_ =
      1e-13 * (extremes.high - extremes.low) + 4.0 * kEps * (std::abs(extremes.high) + box_);
  put(0, {Column::Kind::kOuter, first_row_of(distances, extremes.high)});
  put(1, {Column::Kind::kInner, first_row_of(distances, extremes.low)});
  // The box takes up the imbalance of the two points, so the basis is triangular.
  inverse_.setIdentity();
  values_.template head<2>().setOnes();
  for (int k = 0; k < K; ++k) {
    const double outer = columns_(k + 2, 0);
    const double inner = columns_(k + 2, 1);
    const double rest = outer + inner;
    const double sign = rest > 0.0 ? -1.0 : 1.0;
    put(k + 2,
        {rest > 0.0 ? Column::Kind::kBoxDown : Column::Kind::kBoxUp, static_cast<std::size_t>(k)});
    inverse_(k + 2, 0) = -sign * outer;
    inverse_(k + 2, 1) = -sign * inner;
    inverse_(k + 2, k + 2) = sign;
    values_(k + 2) = std::abs(rest);
  }
}

/// Makes a column basic.
template <int K>
void ZoneSimplex<K>::put(int place, const Column& c) {
  basis_[static_cast<std::size_t>(place)] = c;
  auto column = columns_.col(place);
  if (c.kind == Column::Kind::kOuter || c.kind == Column::Kind::kInner) {
    const bool outer = c.kind == Column::Kind::kOuter;
    const double weight = outer ? weights_.outer : -weights_.inner;
    column(0) = outer ? 1.0 : 0.0;
    column(1) = outer ? 0.0 : 1.0;
    for (int k = 0; k < K; ++k) {
      column(k + 2) = weight * gradients_[static_cast<std::size_t>(k)][c.index];
    }
    costs_(place) = weight * rows_->distances()[c.index];
    return;
  }
  column.setZero();
  column(static_cast<Eigen::Index>(c.index) + 2) = c.kind == Column::Kind::kBoxUp ? 1.0 : -1.0;
  costs_(place) = -box_;
}

/// Computes the inverse of the basis from its columns.
/// @return Whether there is one.
template <int K>
bool ZoneSimplex<K>::factorise() {
  if (!invert<kRows>(columns_, inverse_)) return false;
  values_ = inverse_.col(0) + inverse_.col(1);
  return true;
}

/// Solves with fast updates of the inverse. If the residuals of the result are too large, solves
/// again from the beginning, with every basis factorised.
template <int K>
ZoneStep<K> ZoneSimplex<K>::run(int pivot_limit) {
  ZoneStep<K> out = attempt(pivot_limit, kSwiftPivots);
  if (!solves_basis()) {
    const int spent = out.pivots;
    start_basis();
    out = attempt(pivot_limit, 0);
    out.pivots += spent;
  }
  report(out);
  return out;
}

/// @param swift  Number of pivots that update the inverse; later ones factorise and refine.
template <int K>
ZoneStep<K> ZoneSimplex<K>::attempt(int pivot_limit, int swift) {
  ZoneStep<K> out;
  bool fresh = false;
  for (; out.pivots < pivot_limit; ++out.pivots) {
    const bool careful = out.pivots >= swift;
    if (careful && !factorise()) return out;
    settle_prices();
    if (careful) needs_refactorization();
    const Entering entering = price(out.pivots >= kDantzigPivots);
    if (entering.found && pivot(entering.column)) {
      fresh = false;
      continue;
    }
    out.solved = true;
    const bool again = needs_refactorization() && !fresh;
    if (!again || !factorise()) break;
    fresh = true;
  }
  if (!out.solved) {
    settle_prices();
    needs_refactorization();
  }
  return out;
}

/// Whether multipliers and prices solved the equations of the basis before their refinement, and no
/// multiplier is negative.
template <int K>
bool ZoneSimplex<K>::solves_basis() const {
  return value_flaw_ <= kSound && price_flaw_ <= kSound * (1.0 + box_) &&
         values_.minCoeff() >= -kSound;
}

template <int K>
auto ZoneSimplex<K>::value_residual() const -> Vector {
  Vector out = Vector::Zero();
  out(0) = out(1) = 1.0;
  for (int k = 0; k < kRows; ++k) out -= values_(k) * columns_.col(k);
  return out;
}

template <int K>
auto ZoneSimplex<K>::price_residual() const -> Vector {
  Vector out;
  for (int k = 0; k < kRows; ++k) out(k) = costs_(k) - columns_.col(k).dot(prices_);
  return out;
}

/// Computes the prices of the rows, c_B times the inverse of the basis.
template <int K>
void ZoneSimplex<K>::settle_prices() {
  for (int k = 0; k < kRows; ++k) prices_(k) = inverse_.col(k).dot(costs_);
}

/// Refines multipliers and prices once with their residuals.
/// @return Whether the residuals were so large that the inverse should be computed anew.
template <int K>
bool ZoneSimplex<K>::needs_refactorization() {
  const Vector value_rest = value_residual();
  const Vector price_rest = price_residual();
  value_flaw_ = value_rest.cwiseAbs().maxCoeff();
  price_flaw_ = price_rest.cwiseAbs().maxCoeff();
  Vector value_error = Vector::Zero();
  Vector price_error;
  for (int k = 0; k < kRows; ++k) {
    value_error += value_rest(k) * inverse_.col(k);
    price_error(k) = inverse_.col(k).dot(price_rest);
  }
  values_ += value_error;
  prices_ += price_error;
  return !(value_error.cwiseAbs().maxCoeff() <= kWorn &&
           price_error.cwiseAbs().maxCoeff() <= std::max(tolerance_, kEps * box_));
}

/// Finds the column that violates its constraint most (by Bland's rule: the first that does).
template <int K>
auto ZoneSimplex<K>::price(bool bland) -> Entering {
  const Unknowns move = -prices_.template tail<K>();
  const std::size_t count = rows_->size();
  const Extremes extremes =
      move_column<K>(rows_->distances(), gradients_.data(), move.data(), moved_.data());
  double worst = tolerance_;
  Entering entering;
  const auto offer = [&](double violation, typename Column::Kind kind, std::size_t index) {
    if (violation <= worst || (bland && entering.found)) return;
    worst = violation;
    entering = {{kind, index}, true};
  };
  const double outer = prices_(0);
  const double inner = prices_(1);
  if (bland) {
    for (std::size_t i = 0; i < count; ++i)
      offer(weights_.outer * moved_[i] - outer, Column::Kind::kOuter, i);
    for (std::size_t i = 0; i < count; ++i)
      offer(-weights_.inner * moved_[i] - inner, Column::Kind::kInner, i);
  } else {
    // The row is sought only on the side with the larger violation.
    const double far = weights_.outer * extremes.high - outer;
    const double near = -weights_.inner * extremes.low - inner;
    if (far >= near && far > worst) {
      offer(far, Column::Kind::kOuter, first_row_of(moved_, extremes.high));
    } else if (near > worst) {
      offer(near, Column::Kind::kInner, first_row_of(moved_, extremes.low));
    }
  }
  for (int k = 0; k < K; ++k) {
    offer(move(k) - box_, Column::Kind::kBoxUp, static_cast<std::size_t>(k));
  }
  for (int k = 0; k < K; ++k) {
    offer(-box_ - move(k), Column::Kind::kBoxDown, static_cast<std::size_t>(k));
  }
  return entering;
}

/// The column as a linear combination of the basic ones.
template <int K>
auto ZoneSimplex<K>::in_basis(const Column& c) const -> Vector {
  if (c.kind == Column::Kind::kBoxUp) return inverse_.col(static_cast<Eigen::Index>(c.index) + 2);
  if (c.kind == Column::Kind::kBoxDown)
    return -inverse_.col(static_cast<Eigen::Index>(c.index) + 2);
  const bool outer = c.kind == Column::Kind::kOuter;
  const double weight = outer ? weights_.outer : -weights_.inner;
  Vector out = inverse_.col(outer ? 0 : 1);
  for (int k = 0; k < K; ++k) {
    out += weight * gradients_[static_cast<std::size_t>(k)][c.index] * inverse_.col(k + 2);
  }
  return out;
}

/// Exchanges the entering column for a basic one.
/// @return false if no basic column limits it, which the box excludes.
template <int K>
bool ZoneSimplex<K>::pivot(const Column& entering) {
  const Vector direction = in_basis(entering);
  int leaving = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kRows; ++k) {
    if (direction(k) <= kPivot) continue;
    const double ratio = std::max(values_(k), 0.0) / direction(k);
    // Among equal ratios the larger pivot is numerically safer.
    const bool tie = leaving >= 0 && std::abs(ratio - least) <= 1e-14;
    if ((!tie && ratio < least) || (tie && direction(k) > direction(leaving))) {
      leaving = k;
      least = std::min(least, ratio);
    }
  }
  if (leaving < 0) return false;
  const Eigen::Matrix<double, 1, kRows> row = inverse_.row(leaving) / direction(leaving);
  for (int k = 0; k < kRows; ++k) {
    if (k != leaving) inverse_.row(k) -= direction(k) * row;
  }
  inverse_.row(leaving) = row;
  values_ = inverse_.col(0) + inverse_.col(1);
  put(leaving, entering);
  return true;
}

template <int K>
void ZoneSimplex<K>::report(ZoneStep<K>& out) const {
  out.step = -prices_.template tail<K>();
  out.value = prices_(0) + prices_(1);
  out.inside_box = true;
  for (int k = 0; k < kRows; ++k) {
    const Column& c = basis_[static_cast<std::size_t>(k)];
    const double value = values_(k);
    if (c.kind != Column::Kind::kOuter && c.kind != Column::Kind::kInner) {
      if (value > 1e-9) out.inside_box = false;
      continue;
    }
    const bool outer = c.kind == Column::Kind::kOuter;
    // A side without weight takes part in the programme only formally.
    if (value <= 0.0 || (outer ? weights_.outer : weights_.inner) == 0.0) continue;
    (outer ? out.outer : out.inner).push_back({c.index, value});
  }
  std::ranges::sort(out.outer, {}, &Contact::index);
  std::ranges::sort(out.inner, {}, &Contact::index);
}

template class ZoneSimplex<1>;
template class ZoneSimplex<2>;
template class ZoneSimplex<3>;
template class ZoneSimplex<4>;

}  // namespace rondure::fit
