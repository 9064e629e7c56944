#include "fit/zone/descent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Dense>

#include "fit/geometry/points.h"

namespace rondure::fit {
namespace {

constexpr int kLinearProgramLimit = 200;
constexpr int kPassLimit = 100;
constexpr int kSaddleLimit = 20;
constexpr int kLevelLimit = 4;
/// The descent on a sample stops when the predicted gain is less than this part of its zone.
constexpr double kCoarse = 0.005;
/// A contact with a smaller multiplier may be redundant.
constexpr double kFirm = 1e-9;
constexpr int kNewtonLimit = 20;
/// Most sets of contacts that are tried in turn.
constexpr int kExchangeLimit = 8;
/// A contact with a smaller multiplier hardly fixes a vertex.
constexpr double kWeak = 1e-4;

/// Points of the first sample: enough to come near the optimum, few compared with a pass.
template <int K>
std::size_t sample_size(std::size_t count) {
  return K == 2 ? std::clamp<std::size_t>(count / 200, 24, 1000)
                : std::clamp<std::size_t>(count / 500, 48, 1000);
}
/// Points per block of a pass. Each block gives at most one candidate per side.
template <int K>
std::size_t block_size(std::size_t count) {
  if (count < 4000) return 32;
  return K == 2 ? (count < 20000 ? 64 : 256) : (count < 20000 ? 32 : 128);
}
/// Candidates per side and pass. The first pass takes more, because its place is not yet good, and
/// larger sets take more, because each candidate is cheap compared with a pass.
template <int K>
std::size_t candidates(int pass, std::size_t blocks) {
  if (K != 2) return pass == 1 ? 128 : 48;
  return pass == 1 ? std::clamp<std::size_t>(blocks / 12, 32, 128) : 32;
}

/// The contacts with this multiplier or more.
Contacts with_at_least(double multiplier, const Contacts& contacts) {
  Contacts out;
  for (const Contact& c : contacts) {
    if (c.multiplier >= multiplier) out.push_back(c);
  }
  return out;
}

}  // namespace

double distance_round_off(double size_mm) {
  return 2.0 * std::numeric_limits<double>::epsilon() * std::max(size_mm, 1e-3);
}

template <class Frame>
auto ZoneDescent<Frame>::run(Points points, const Point& origin, const Frame& start,
                             const ZoneWeights& weights, double round_off, double limit_mm)
    -> Result {
  weights_ = weights;
  round_off_ = round_off;
  warm_ = coarse_ = false;
  Result state(start);
  if (points.size() > kAllWorked) {
    working_.clear();
    for (std::size_t k = 0; k < sample_size<K>(points.size()); ++k) {
      const std::size_t row = spread_row(k, points.size());
      working_.add(row, points[row] - origin);
    }
    minimise_large(points, origin, start, limit_mm, state);
  } else {
    working_.assign(points, origin);
    minimise(state, start, limit_mm);
  }
  name_rows(state.outer);
  name_rows(state.inner);
  return state;
}

/// Replaces the working points of contacts by rows of the data, in the order of the rows.
template <class Frame>
void ZoneDescent<Frame>::name_rows(Contacts& contacts) const {
  for (Contact& c : contacts) c.index = working_.row(c.index);
  std::ranges::sort(contacts, {}, &Contact::index);
}

template <class Frame>
Extremes ZoneDescent<Frame>::extremes(const Frame& frame) {
  return frame.linearise(working_, looked_rows_);
}

/// Minimises over the working points and adds points outside the zone, until there are none.
template <class Frame>
void ZoneDescent<Frame>::minimise_large(Points points, const Point& origin, const Frame& start,
                                        double limit_mm, Result& state) {
  blocks_.block = block_size<K>(points.size());
  while (state.passes < kPassLimit) {
    coarse_ = state.passes == 0;
    minimise(state, start, limit_mm);
    if (state.ending == ZoneEnding::kStrayed) return;
    state.frame = state.frame.snapped(origin);
    state.zone = extremes(state.frame);
    scan_blocks(points, state.frame.place(origin), blocks_);
    ++state.passes;
    if (!blocks_.all.finite) {
      state.ending = ZoneEnding::kNotFinite;
      return;
    }
    std::size_t added = add_worst(points, origin, state, true);
    added += add_worst(points, origin, state, false);
    if (added == 0 && !coarse_) break;
    state.ending = ZoneEnding::kLimit;
  }
  state.zone = {std::sqrt(blocks_.all.low), std::sqrt(blocks_.all.high)};
}

/// Adds the extreme point of each of the blocks that stick out of the zone of the working points
/// farthest on one side.
/// @return How many.
template <class Frame>
std::size_t ZoneDescent<Frame>::add_worst(Points points, const Point& origin, const Result& state,
                                          bool high) {
  if ((high ? weights_.outer : weights_.inner) == 0.0) return 0;
  const double slack = 4.0 * round_off_;
  const double limit = high ? state.zone.high + slack : std::max(state.zone.low - slack, 0.0);
  const std::vector<double>& extreme = high ? blocks_.high : blocks_.low;
  order_.clear();
  for (std::size_t k = 0; k < extreme.size(); ++k) {
    if (high ? extreme[k] > limit * limit : extreme[k] < limit * limit) order_.push_back(k);
  }
  const std::size_t most = std::min(order_.size(), candidates<K>(state.passes, extreme.size()));
  const auto worse = [&](std::size_t a, std::size_t b) {
    if (extreme[a] != extreme[b]) return high == (extreme[a] > extreme[b]);
    return a < b;
  };
  std::nth_element(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(most), order_.end(),
                   worse);
  const auto place = state.frame.place(origin);
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t begin = order_[k] * blocks_.block;
    const auto block = points.subspan(begin, std::min(blocks_.block, points.size() - begin));
    const std::size_t row = begin + find_square(block, place, extreme[order_[k]]);
    working_.add(row, points[row] - origin);
  }
  return most;
}

/// Descends to a local minimum of the working points. With four contacts in one section the place
/// is stationary, yet a tilt may still narrow the zone by its curvature: the search leaves such
/// saddles and continues.
template <class Frame>
void ZoneDescent<Frame>::minimise(Result& state, const Frame& start, double limit_mm) {
  if constexpr (Frame::kHasBall) {
    if (weights_.inner == 0.0) return enclose(state);
  }
  for (int i = 0; i < kSaddleLimit; ++i) {
    settle(state);
    if (state.frame.strayed(start, limit_mm)) {
      state.ending = ZoneEnding::kStrayed;
      return;
    }
    state.ending = ZoneEnding::kLimit;
    if (state.linear_programs >= kLinearProgramLimit * (state.passes + 1)) return;
    state.ending = ZoneEnding::kConverged;
    if (coarse_) return;
    if (vertex_) return slip(state);
    if (!leave_saddle(state)) return;
  }
}

/// Finds the smallest ball of the working points, which needs no good start.
template <class Frame>
void ZoneDescent<Frame>::enclose(Result& state) {
  if constexpr (Frame::kHasBall) {
    const Ball<D> ball = ball_.enclose(working_, warm_, round_off_);
    warm_ = true;
    coarse_ = false;
    state.frame = Frame(ball.center_mm);
    state.zone = ball.zone;
    state.outer = ball.outer;
    state.pivots += ball.exchanges;
    state.ending = ball.solved ? ZoneEnding::kConverged : ZoneEnding::kLimit;
  }
}

/// Linearises at a frame, with distances relative to the inner radius, so that they keep their
/// digits in a programme.
template <class Frame>
Extremes ZoneDescent<Frame>::linearise(const Frame& frame, ZoneRows<K>& rows) const {
  const Extremes zone = frame.linearise(working_, rows);
  for (double& distance : rows.distances()) distance -= zone.low;
  return zone;
}

/// Solves the programme at the state and takes over its contacts.
template <class Frame>
auto ZoneDescent<Frame>::programme(Result& state, double box) -> ZoneStep<K> {
  const ZoneStep<K> step =
      warm_ ? program_.solve_again(rows_, box, weights_) : program_.solve(rows_, box, weights_);
  warm_ = true;
  ++state.linear_programs;
  state.pivots += step.pivots;
  state.outer = step.outer;
  state.inner = step.inner;
  return step;
}

/// Descends to a stationary point by linear programs inside a trust region, then by Newton.
template <class Frame>
void ZoneDescent<Frame>::settle(Result& state) {
  state.zone = linearise(state.frame, rows_);
  double box = std::max(10.0 * state.zone.width(), 64.0 * round_off_);
  bool rejected = false;
  int levels = 0;
  vertex_ = polished_ = false;
  const int limit = state.linear_programs + kLinearProgramLimit;
  while (state.linear_programs < limit && box > round_off_) {
    const ZoneStep<K> step = programme(state, box);
    const double base = (weights_.outer - weights_.inner) * state.zone.low;
    const double promised = weights_.value(state.zone) - base - step.value;
    if (coarse_ && promised <= kCoarse * state.zone.width()) return;
    if (promised <= 2.0 * round_off_) {
      const bool level_now = step.step.cwiseAbs().maxCoeff() <= round_off_;
      vertex_ = is_vertex(step) && level_now;
      if (vertex_ || !is_vertex(step) || levels++ == kLevelLimit || !level(state, step)) break;
      continue;
    }
    // With fewer contacts than fix a vertex, or after a refused step, curvature determines the
    // rest. A linear programme does not include curvature; Newton's method does.
    if (rejected || !step.inside_box) {
      polished_ = polish(state);
      if (polished_) return;
    }
    const Frame next = state.frame.moved(step.step);
    const Extremes zone = linearise(next, trial_rows_);
    const double gained = weights_.value(state.zone) - weights_.value(zone);
    // Straight steps are short in a curved valley; Newton's follow it to the next contact.
    if (gained < 0.5 * promised && stride(state, std::max(gained, 2.0 * round_off_))) continue;
    rejected = !(gained >= 0.1 * promised);
    if (rejected) {
      box *= 0.5;
      continue;
    }
    if (gained > 0.75 * promised && !step.inside_box) box *= 2.0;
    state.frame = next;
    state.zone = zone;
    std::swap(rows_, trial_rows_);
    // The path was straight, so a second step would not gain enough for its programme.
    if (coarse_ && step.inside_box && gained > 0.9 * promised) return;
  }
  if (!vertex_ && !coarse_) settle_by_curvature(state, box);
}

/// Brings all contacts to their radius by further steps of the programme: a contact with a small
/// multiplier may be off its radius with hardly any effect on the value.
/// @return Whether the state moved.
template <class Frame>
bool ZoneDescent<Frame>::level(Result& state, const ZoneStep<K>& step) {
  const Frame next = state.frame.moved(step.step);
  const Extremes zone = linearise(next, trial_rows_);
  if (weights_.value(zone) > weights_.value(state.zone) + 2.0 * round_off_) return false;
  state.frame = next;
  state.zone = zone;
  std::swap(rows_, trial_rows_);
  return true;
}

template <class Frame>
bool ZoneDescent<Frame>::is_vertex(const ZoneStep<K>& step) const {
  const int sides = (weights_.outer > 0.0 ? 1 : 0) + (weights_.inner > 0.0 ? 1 : 0);
  if (!step.inside_box) return false;
  if (step.outer.size() + step.inner.size() != static_cast<std::size_t>(K + sides)) return false;
  const auto firm = [](const Contact& c) { return c.multiplier > kFirm; };
  return std::ranges::all_of(step.outer, firm) && std::ranges::all_of(step.inner, firm);
}

// The functions below use curvature, which linear programs do not include: Newton's method on the
// equations of the contacts where curvature determines the minimum, and descent where it does not.

/// A step of Newton's method on the contact equations, with its multipliers.
template <class Frame>
struct ZoneDescent<Frame>::Newton {
  Eigen::Matrix<double, K, 1> move = Eigen::Matrix<double, K, 1>::Zero();
  Contacts outer;
  Contacts inner;
  bool valid = false;
};

/// Takes a step of Newton's method, or the part of it that gains most.
/// @return Whether it gained more than `least`.
template <class Frame>
bool ZoneDescent<Frame>::stride(Result& state, double least) {
  const Newton next = newton_step(state);
  if (!next.valid || next.move.cwiseAbs().maxCoeff() > 100.0 * state.zone.width()) return false;
  double best = weights_.value(state.zone) - least;
  double part = 0.0;
  for (const double t : {1.0, 0.5, 0.25, 0.125, -0.125, -0.5}) {
    const double reached = weights_.value(extremes(state.frame.moved(t * next.move)));
    if (reached >= best) continue;
    best = reached;
    part = t;
  }
  if (part == 0.0) return false;
  state.frame = state.frame.moved(part * next.move);
  state.zone = linearise(state.frame, rows_);
  return true;
}

/// Narrows the trust region where curvature determines the minimum. A wide programme then takes
/// points for contacts that are only near; narrower ones name fewer, until Newton's method
/// converges on the true contacts.
template <class Frame>
void ZoneDescent<Frame>::settle_by_curvature(Result& state, double box) {
  for (polished_ = polish(state); !polished_ && box > round_off_; box *= 0.125) {
    state.zone = linearise(state.frame, rows_);
    programme(state, box);
    polished_ = polish(state);
  }
}

/// Unknowns: the move, the radius of each side with a weight, the multipliers of the contacts.
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
    // r + J x = R of its side, relative to the inner radius to keep the digits.
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

/// Applies Newton's method to the stationarity equations of the current contacts. A contact that
/// would have to pull, with a multiplier below 0, holds nothing, and the others alone are tried; a
/// point that then sticks out is one more contact.
/// @return Whether it converged to a zone that is not wider, with multipliers >= 0; `state` is then
///         that zone.
template <class Frame>
bool ZoneDescent<Frame>::polish(Result& state) {
  Result trial = state;
  bool changed = true;
  for (int round = 0; changed; ++round) {
    if (round == kExchangeLimit) return false;
    if ((weights_.outer > 0.0 && trial.outer.empty()) ||
        (weights_.inner > 0.0 && trial.inner.empty())) {
      return false;
    }
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
    const std::size_t contacts = trial.outer.size() + trial.inner.size();
    trial.outer = with_at_least(0.0, trial.outer);
    trial.inner = with_at_least(0.0, trial.inner);
    changed = trial.outer.size() + trial.inner.size() < contacts;
    if (changed) continue;
    const auto& distances = looked_rows_.distances();
    const auto add = [&](Contacts& side, auto farther) {
      const std::size_t sides = (trial.outer.empty() ? 0 : 1) + (trial.inner.empty() ? 0 : 1);
      if (side.empty() || trial.outer.size() + trial.inner.size() >= K + sides) return;
      const auto at =
          std::ranges::max_element(distances, [&](double a, double b) { return farther(b, a); });
      const double off = std::abs(*at - distances[side[0].index]);
      if (off <= 16.0 * round_off_) return;
      side.push_back({static_cast<std::size_t>(at - distances.begin()), 0.0});
      changed = true;
    };
    add(trial.outer, std::greater<double>());
    add(trial.inner, std::less<double>());
  }
  if (!(weights_.value(trial.zone) <= weights_.value(state.zone) + 4.0 * round_off_)) return false;
  if (!contacts_hold(trial)) return false;
  state = trial;
  return true;
}

/// Whether every contact is on its radius, so that no outdated contact carries a multiplier.
template <class Frame>
bool ZoneDescent<Frame>::contacts_hold(const Result& state) const {
  const double slack = 16.0 * round_off_;
  const auto at_least = [&](const Contact& c) {
    return state.frame.distance(working_[c.index]) >= state.zone.high - slack;
  };
  const auto at_most = [&](const Contact& c) {
    return state.frame.distance(working_[c.index]) <= state.zone.low + slack;
  };
  return std::ranges::all_of(state.outer, at_least) && std::ranges::all_of(state.inner, at_most);
}

/// The direction in which the zone shrinks most by curvature while the contacts of a state stay
/// level; zero if there is none.
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

/// Follows a valley that is closed only by weak contacts. Contacts with a tiny multiplier fix a
/// minimum zone only over a tiny distance. If curvature does not fix it with the other contacts
/// alone, the zone is nearly constant along a valley, up to the next contact; the better end of the
/// valley is the minimum.
template <class Frame>
void ZoneDescent<Frame>::slip(Result& state) {
  // A one-sided reference is the local optimum next to its start, so it stays.
  if (weights_.outer == 0.0 || weights_.inner == 0.0) return;
  Result here = state;
  here.outer = with_at_least(kWeak, state.outer);
  here.inner = with_at_least(kWeak, state.inner);
  const std::size_t contacts = state.outer.size() + state.inner.size();
  if (here.outer.size() + here.inner.size() == contacts) return;
  const auto valley = curvature_of(here);
  if (valley.isZero()) return;
  const double width = here.zone.width();
  const auto level_at = [&](double size) {
    const Extremes zone = extremes(here.frame.moved(size * valley));
    return weights_.value(zone) <= weights_.value(here.zone) + kWeak * std::abs(size);
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
    if (vertex_ && weights_.value(end.zone) < weights_.value(state.zone) - 2.0 * round_off_)
      state = end;
  }
}

/// The direction that leaves a saddle, or zero if the contacts determine a strict minimum.
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

/// Leaves a saddle along its direction of descent, as far as the zone improves.
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
      if (weights_.value(zone) >= weights_.value(state.zone)) continue;
      state.frame = next;
      state.zone = zone;
    }
  }
  return weights_.value(state.zone) < weights_.value(saddle.zone) - 2.0 * round_off_;
}

template class ZoneDescent<CenterFrame<2>>;
template class ZoneDescent<CenterFrame<3>>;
template class ZoneDescent<CylinderFrame>;

}  // namespace rondure::fit
