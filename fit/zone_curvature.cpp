// The second half of ZoneDescent: what linear programmes cannot see. Newton on the equations of the
// contacts where curvature holds the place, and the ways out of places it does not hold.

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "fit/zone_descent.h"

namespace rondure::fit {
namespace {

constexpr int kNewtonLimit = 20;
/// A contact with a smaller multiplier hardly holds a vertex.
constexpr double kWeak = 1e-4;

bool all_nonnegative(const Contacts& contacts) {
  return std::all_of(contacts.begin(), contacts.end(),
                     [](const Contact& c) { return c.multiplier >= 0.0; });
}

/// The contacts that hold something.
Contacts firm_of(const Contacts& contacts) {
  Contacts out;
  for (const Contact& c : contacts) {
    if (c.multiplier > kWeak) out.push_back(c);
  }
  return out;
}

}  // namespace

/// A step of Newton's method on the contact equations, with its multipliers.
template <class Frame>
struct ZoneDescent<Frame>::Newton {
  Eigen::Matrix<double, K, 1> move = Eigen::Matrix<double, K, 1>::Zero();
  Contacts outer;
  Contacts inner;
  bool valid = false;
};

/// Takes a step of Newton's method, or the part of it that helps most.
/// @return Whether it gained more than `least`.
template <class Frame>
bool ZoneDescent<Frame>::stride(Result& state, double least) {
  const Newton next = newton_step(state);
  if (!next.valid || next.move.cwiseAbs().maxCoeff() > 100.0 * state.zone.width()) return false;
  double best = value(state.zone) - least;
  double part = 0.0;
  for (const double t : {1.0, 0.5, 0.25, 0.125, -0.125, -0.5}) {
    const double reached = value(extremes(state.frame.moved(t * next.move)));
    if (reached >= best) continue;
    best = reached;
    part = t;
  }
  if (part == 0.0) return false;
  state.frame = state.frame.moved(part * next.move);
  state.zone = linearise(state.frame, rows_);
  return true;
}

/// Where curvature holds the place, a wide programme takes points for contacts that are only near:
/// narrower ones name fewer, until Newton settles on those that count.
template <class Frame>
void ZoneDescent<Frame>::settle_by_curvature(Result& state, double box) {
  for (polished_ = polish(state); !polished_ && box > round_off_; box *= 0.125) {
    state.zone = linearise(state.frame, rows_);
    programme(state, box);
    polished_ = polish(state);
  }
}

/// Unknowns: the move, the radius of each side that counts, the multipliers of the contacts.
template <class Frame>
auto ZoneDescent<Frame>::newton_step(const Result& state) const -> Newton {
  constexpr int kMost = K + 2 + 2 * static_cast<int>(Contacts::kCapacity);
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  const auto outer_count = static_cast<Eigen::Index>(state.outer.size());
  const auto count = outer_count + static_cast<Eigen::Index>(state.inner.size());
  const Eigen::Index sides = (state.outer.empty() ? 0 : 1) + (state.inner.empty() ? 0 : 1);
  const Eigen::Index size = K + sides + count;
  Matrix matrix = Matrix::Zero(size, size);
  Column right = Column::Zero(size);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool outer = i < outer_count;
    const Contact& contact = outer ? state.outer[static_cast<std::size_t>(i)]
                                   : state.inner[static_cast<std::size_t>(i - outer_count)];
    const auto row = state.frame.contact_row(working_[contact.index], contact.index);
    const double sign = outer ? weights_.outer : -weights_.inner;
    const Eigen::Index radius = outer ? K : K + sides - 1;
    // r + J x = R of its side, relative to the inner radius, which keeps the digits.
    matrix.template block<1, K>(i, 0) = row.gradient.transpose();
    matrix(i, radius) = -1.0;
    right(i) = state.zone.low - row.distance;
    // W x + sum of signed multipliers times J = 0
    matrix.template block<K, K>(count, 0) += sign * contact.multiplier * row.hessian;
    matrix.template block<K, 1>(count, K + sides + i) = sign * row.gradient;
    // The multipliers of each side sum to 1.
    matrix(count + radius, K + sides + i) = 1.0;
  }
  right.tail(sides).setOnes();
  const Eigen::FullPivLU<Matrix> factor(matrix);
  Newton out;
  if (!factor.isInvertible()) return out;
  const Column solution = factor.solve(right);
  if (!solution.allFinite()) return out;
  out.move = solution.template head<K>();
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool outer = i < outer_count;
    const std::size_t index = outer ? state.outer[static_cast<std::size_t>(i)].index
                                    : state.inner[static_cast<std::size_t>(i - outer_count)].index;
    (outer ? out.outer : out.inner).push_back({index, solution(K + sides + i)});
  }
  out.valid = true;
  return out;
}

/// Newton on the stationarity equations of the current contacts.
/// @return Whether it settled at a zone that is not wider, with multipliers >= 0; then `state` is
/// it.
template <class Frame>
bool ZoneDescent<Frame>::polish(Result& state) {
  if ((weights_.outer > 0.0 && state.outer.empty()) ||
      (weights_.inner > 0.0 && state.inner.empty())) {
    return false;
  }
  Result trial = state;
  double last = std::numeric_limits<double>::infinity();
  bool settled = false;
  for (int i = 0; i < kNewtonLimit && !settled; ++i) {
    const Newton next = newton_step(trial);
    const double size = next.move.cwiseAbs().maxCoeff();
    if (!next.valid || size > 100.0 * state.zone.width() || size > 2.0 * last) return false;
    trial.frame = trial.frame.moved(next.move);
    trial.outer = next.outer;
    trial.inner = next.inner;
    trial.zone = extremes(trial.frame);
    settled = size <= 4.0 * round_off_ || (size <= 1e3 * round_off_ && size >= 0.5 * last);
    last = size;
  }
  if (!settled) return false;
  if (!all_nonnegative(trial.outer) || !all_nonnegative(trial.inner)) return false;
  if (!(value(trial.zone) <= value(state.zone) + 4.0 * round_off_)) return false;
  if (!contacts_hold(trial)) return false;
  state = trial;
  return true;
}

/// Every contact must be on its radius: no stale one may carry a multiplier.
template <class Frame>
bool ZoneDescent<Frame>::contacts_hold(const Result& state) const {
  const double slack = 16.0 * round_off_;
  const auto at_least = [&](const Contact& c) {
    return state.frame.distance(working_[c.index]) >= state.zone.high - slack;
  };
  const auto at_most = [&](const Contact& c) {
    return state.frame.distance(working_[c.index]) <= state.zone.low + slack;
  };
  return std::all_of(state.outer.begin(), state.outer.end(), at_least) &&
         std::all_of(state.inner.begin(), state.inner.end(), at_most);
}

/// Where the zone shrinks most by curvature while the contacts of a state stay level; zero where it
/// does not.
template <class Frame>
auto ZoneDescent<Frame>::curvature_of(const Result& state) const -> Eigen::Matrix<double, K, 1> {
  std::array<ContactRow<K>, Contacts::kCapacity> outer;
  std::array<ContactRow<K>, Contacts::kCapacity> inner;
  const auto rows = [&](const Contacts& side, auto& out) {
    for (std::size_t i = 0; i < side.size(); ++i) {
      out[i] = state.frame.contact_row(working_[side[i].index], side[i].index);
    }
    return std::span<const ContactRow<K>>(out).first(side.size());
  };
  const auto outer_rows = rows(state.outer, outer);
  const auto inner_rows = rows(state.inner, inner);
  return curvature_descent<K>(state.outer, state.inner, outer_rows, inner_rows, weights_);
}

/// Contacts that carry next to nothing hold a minimum zone over next to no distance. Where the
/// others alone do not hold it by curvature, the zone is all but level along a valley, up to the
/// next contact; the better end of the valley is the minimum.
template <class Frame>
void ZoneDescent<Frame>::slip(Result& state) {
  // A one-sided reference is the one next to its start.
  if (weights_.outer == 0.0 || weights_.inner == 0.0) return;
  Result here = state;
  here.outer = firm_of(state.outer);
  here.inner = firm_of(state.inner);
  const std::size_t contacts = state.outer.size() + state.inner.size();
  if (here.outer.size() + here.inner.size() == contacts) return;
  const auto valley = curvature_of(here);
  if (valley.isZero()) return;
  const double width = here.zone.width();
  const auto level_at = [&](double size) {
    const Extremes zone = extremes(here.frame.moved(size * valley));
    return value(zone) <= value(here.zone) + kWeak * std::abs(size);
  };
  for (const double side : {1.0, -1.0}) {
    double size = 2.0 * side * width;
    while (std::abs(size) > 0.01 * width && !level_at(size)) size *= 0.5;
    if (!level_at(size)) continue;
    for (double more = 0.5; more > 0.05; more *= 0.5) {
      if (level_at(size * (1.0 + more))) size *= 1.0 + more;
    }
    Result end = here;
    end.frame = here.frame.moved(size * valley);
    settle(end);
    if (vertex_ && value(end.zone) < value(state.zone) - 2.0 * round_off_) state = end;
  }
}

/// The way out of a saddle, or zero when the contacts hold a strict minimum.
template <class Frame>
auto ZoneDescent<Frame>::escape(const Result& state) const -> Eigen::Matrix<double, K, 1> {
  if (polished_ && curvature_of(state).isZero()) return Eigen::Matrix<double, K, 1>::Zero();
  const double slack = 16.0 * round_off_;
  std::vector<ContactRow<K>> outer;
  std::vector<ContactRow<K>> inner;
  for (std::size_t i = 0; i < working_.size(); ++i) {
    const Point p = working_[i];
    const double r = state.frame.distance(p);
    if (weights_.outer > 0.0 && r >= state.zone.high - slack) {
      outer.push_back(state.frame.contact_row(p, i));
    }
    if (weights_.inner > 0.0 && r <= state.zone.low + slack) {
      inner.push_back(state.frame.contact_row(p, i));
    }
  }
  const auto proof = prove_local<K>(outer, inner, state.zone.width(), weights_);
  if (proof.strict) return Eigen::Matrix<double, K, 1>::Zero();
  return proof.descent;
}

/// Leaves a saddle along its descent, as far as that helps.
/// @return Whether the zone became better by more than round-off.
template <class Frame>
bool ZoneDescent<Frame>::leave_saddle(Result& state) {
  const auto descent = escape(state);
  if (descent.isZero()) return false;
  const Result saddle = state;
  const double width = saddle.zone.width();
  for (double size = 100.0 * width; size > 1e-6 * width; size *= 0.5) {
    for (const double sign : {1.0, -1.0}) {
      const Frame next = saddle.frame.moved(sign * size * descent);
      const Extremes zone = extremes(next);
      if (value(zone) >= value(state.zone)) continue;
      state.frame = next;
      state.zone = zone;
    }
  }
  return value(state.zone) < value(saddle.zone) - 2.0 * round_off_;
}

template class ZoneDescent<CenterFrame<2>>;
template class ZoneDescent<CenterFrame<3>>;
template class ZoneDescent<CylinderFrame>;

}  // namespace rondure::fit
