#include "fit/geometry/enclosing_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Dense>

namespace rondure::fit {
namespace {

constexpr int kExchangeLimit = 1000;
/// Differences of contacts are linearly dependent to round-off when they span less than this part
/// of the box of their lengths.
constexpr double kDependent = 1e-12;

}  // namespace

template <int D>
Ball<D> EnclosingBall<D>::enclose(const WorkingPoints<D>& points, bool again, double round_off) {
  column_.resize(points.size());
  Ball<D> out;
  if (!again) start(points, out);
  while (out.exchanges < kExchangeLimit) {
    const std::size_t farthest = look(points);
    const double limit = std::sqrt(square_) + 2.0 * round_off;
    // If the farthest point is itself a contact, it is so only by round-off.
    const auto contacts = std::span(rows_).first(static_cast<std::size_t>(count_));
    const bool known = std::ranges::find(contacts, farthest) != contacts.end();
    out.solved = known || squares_.high <= limit * limit;
    if (out.solved) break;
    append(points, farthest, 0.0);
    ++out.exchanges;
    if (!enter(out)) break;
  }
  out.center_mm = center_;
  out.zone = {std::sqrt(squares_.low), std::sqrt(squares_.high)};
  for (int i = 0; i < count_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (multipliers_[k] > 0.0) out.outer.push_back({rows_[k], multipliers_[k]});
  }
  return out;
}

/// The ball of the two points that are farthest apart along the first coordinate.
template <int D>
void EnclosingBall<D>::start(const WorkingPoints<D>& points, Ball<D>& out) {
  const std::span<const double> places(points.column(0), points.size());
  const Extremes ends = column_extremes(places);
  const std::size_t low = first_row_of(places, ends.low);
  const std::size_t high = first_row_of(places, ends.high);
  count_ = 0;
  append(points, low, 1.0);
  center_ = points_[0];
  square_ = 0.0;
  if (high == low) return;
  append(points, high, 0.0);
  enter(out);
}

/// Computes the squared distances of all points from the centre.
/// @return The row of the farthest point.
template <int D>
std::size_t EnclosingBall<D>::look(const WorkingPoints<D>& points) {
  std::array<const double*, D> columns;
  for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(k)] = points.column(k);
  squares_ = square_column<D>(points.size(), columns.data(), center_.data(), column_.data());
  return first_row_of(column_, squares_.high);
}

template <int D>
void EnclosingBall<D>::append(const WorkingPoints<D>& points, std::size_t row, double multiplier) {
  const auto k = static_cast<std::size_t>(count_++);
  rows_[k] = row;
  points_[k] = points[row];
  multipliers_[k] = multiplier;
}

/// Removes a contact; the last one remains the last.
template <int D>
void EnclosingBall<D>::drop(int i) {
  --count_;
  for (auto k = static_cast<std::size_t>(i); k < static_cast<std::size_t>(count_); ++k) {
    rows_[k] = rows_[k + 1];
    points_[k] = points_[k + 1];
    multipliers_[k] = multipliers_[k + 1];
  }
}

/// The dual step: the multiplier of the last point grows from 0 until all contacts are at one
/// distance; contacts whose multiplier reaches 0 before that leave.
/// @return false if round-off leaves no such step.
template <int D>
bool EnclosingBall<D>::enter(Ball<D>& out) {
  while (count_ > 1) {
    const int others = count_ - 1;
    Eigen::Matrix<double, D + 1, 1> target;
    const bool balanced = balance(target);
    const Eigen::Matrix<double, D + 1, 1> slope =
        balanced ? target : Eigen::Matrix<double, D + 1, 1>(-dependence());
    double part = balanced ? 1.0 : std::numeric_limits<double>::infinity();
    int leaving = -1;
    for (int i = 0; i < others; ++i) {
      // The multiplier falls towards the target, or without end along the slope of a dependence.
      const double value = multipliers_[static_cast<std::size_t>(i)];
      const double fall = balanced ? value - slope(i) : -slope(i);
      if ((balanced && slope(i) >= 0.0) || fall <= 0.0 || value > part * fall) continue;
      part = value / fall;
      leaving = i;
    }
    if (!std::isfinite(part)) return false;
    double sum = 0.0;
    for (int i = 0; i < others; ++i) {
      double& value = multipliers_[static_cast<std::size_t>(i)];
      value = i == leaving ? 0.0
              : balanced   ? value + part * (slope(i) - value)
                           : value + part * slope(i);
      sum += value;
    }
    multipliers_[static_cast<std::size_t>(others)] = 1.0 - sum;
    if (leaving >= 0) {
      drop(leaving);
      ++out.exchanges;
      continue;
    }
    const Point& last = points_[static_cast<std::size_t>(others)];
    Point from_last = Point::Zero();
    for (int i = 0; i < others; ++i)
      from_last += slope(i) * (points_[static_cast<std::size_t>(i)] - last);
    center_ = last + from_last;
    square_ = from_last.squaredNorm();
    return true;
  }
  return false;
}

/// Multipliers of the M other contacts that put all contacts at one distance from their mean.
/// @return false where the contacts depend on each other.
template <int D>
template <int M>
bool EnclosingBall<D>::balance(Eigen::Matrix<double, D + 1, 1>& target) const {
  Eigen::Matrix<double, D, M> differences;
  double box = 1.0;
  for (int i = 0; i < M; ++i) {
    differences.col(i) = points_[static_cast<std::size_t>(i)] - points_[M];
    box *= differences.col(i).squaredNorm();
  }
  const Eigen::Matrix<double, M, 1> half = 0.5 * differences.colwise().squaredNorm().transpose();
  if constexpr (M == D) {
    const double volume = differences.determinant();
    if (!(volume * volume > kDependent * kDependent * box)) return false;
    const Eigen::Matrix<double, D, D> inverse = differences.inverse();
    target.template head<M>() = inverse * (inverse.transpose() * half);
  } else {
    const Eigen::Matrix<double, M, M> gram = differences.transpose() * differences;
    if (!(gram.determinant() > kDependent * box)) return false;
    target.template head<M>() = gram.inverse() * half;
  }
  return true;
}

template <int D>
bool EnclosingBall<D>::balance(Eigen::Matrix<double, D + 1, 1>& target) const {
  switch (count_ - 1) {
    case 1:
      target(0) = 0.5;
      return true;
    case 2:
      return balance<2>(target);
    case 3:
      if constexpr (D == 3) return balance<3>(target);
      return false;
    default:
      return false;  // more contacts than a centre has equations
  }
}

/// The last point as a weighted mean of the others, on which it depends linearly.
template <int D>
Eigen::Matrix<double, D + 1, 1> EnclosingBall<D>::dependence() const {
  const int others = count_ - 1;
  const Point& first = points_[0];
  const Point last = points_[static_cast<std::size_t>(others)] - first;
  Eigen::Matrix<double, D + 1, 1> out = Eigen::Matrix<double, D + 1, 1>::Zero();
  Eigen::Matrix<double, D, Eigen::Dynamic, 0, D, D> sides(D, others - 1);
  for (int i = 1; i < others; ++i) sides.col(i - 1) = points_[static_cast<std::size_t>(i)] - first;
  if (others == D + 1) {
    const Eigen::Matrix<double, D, D> all = sides;
    out.template segment<D>(1) = all.inverse() * last;
  } else {
    out.segment(1, others - 1) = sides.colPivHouseholderQr().solve(last);
  }
  out(0) = 1.0 - out.segment(1, others - 1).sum();
  return out;
}

template class EnclosingBall<2>;
template class EnclosingBall<3>;

}  // namespace rondure::fit
