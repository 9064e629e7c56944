#include "fit/zone_descent.h"

#include <algorithm>
#include <cmath>

#include "fit/points.h"

namespace rondure::fit {
namespace {

constexpr int kProgrammeLimit = 200;
constexpr int kPassLimit = 100;
constexpr int kSaddleLimit = 20;
constexpr int kLevelLimit = 4;
/// The minimum of a sample is good enough when it promises less than this part of its zone.
constexpr double kCoarse = 0.005;
/// A contact with a smaller multiplier may be one too many.
constexpr double kFirm = 1e-9;

/// Points of the first sample: enough to come near, few against a pass.
template <int K>
std::size_t sample_size(std::size_t count) {
  return K == 2 ? std::clamp<std::size_t>(count / 200, 24, 1000)
                : std::clamp<std::size_t>(count / 500, 48, 1000);
}
/// Points a block of a pass: each block gives one candidate a side at most.
template <int K>
std::size_t block_size(std::size_t count) {
  if (count < 4000) return 32;
  return K == 2 ? (count < 20000 ? 64 : 256) : (count < 20000 ? 32 : 128);
}
/// Candidates a side and pass: the first pass meets a place that is not yet good, and more of them
/// are cheap where a pass costs more.
template <int K>
std::size_t candidates(int pass, std::size_t blocks) {
  if (K != 2) return pass == 1 ? 128 : 48;
  return pass == 1 ? std::clamp<std::size_t>(blocks / 12, 32, 128) : 32;
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
      take(points, origin, spread_row(k, points.size()));
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

template <class Frame>
void ZoneDescent<Frame>::take(Points points, const Point& origin, std::size_t row) {
  working_.add(row, points[row] - origin);
}

/// Contacts by row of the data instead of working point, in the order of the rows.
template <class Frame>
void ZoneDescent<Frame>::name_rows(Contacts& contacts) const {
  for (Contact& c : contacts) c.index = working_.row(c.index);
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return a.index < b.index; });
}

template <class Frame>
Extremes ZoneDescent<Frame>::extremes(const Frame& frame) {
  return frame.linearise(working_, looked_rows_);
}

/// Minimises over the working points, looks at all, adds those outside, until there are none.
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
    if (!add_violators(points, origin, state) && !coarse_) break;
    state.ending = ZoneEnding::kLimit;
  }
  state.zone = {std::sqrt(blocks_.all.low), std::sqrt(blocks_.all.high)};
}

/// @return Whether a point lies outside the zone of the working points.
template <class Frame>
bool ZoneDescent<Frame>::add_violators(Points points, const Point& origin, const Result& state) {
  std::size_t added = 0;
  if (weights_.outer > 0.0) added += add_worst(points, origin, state, true);
  if (weights_.inner > 0.0) added += add_worst(points, origin, state, false);
  return added > 0;
}

/// Adds the extreme point of each of the blocks that stick out farthest on one side.
template <class Frame>
std::size_t ZoneDescent<Frame>::add_worst(Points points, const Point& origin, const Result& state,
                                          bool high) {
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
    take(points, origin, begin + find_square(block, place, extreme[order_[k]]));
  }
  return most;
}

/// To a local minimum of the working points. Four contacts in one section are stationary, yet a
/// tilt may still narrow the zone by its curvature: such saddles are left and the search goes on.
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
    if (state.programmes >= kProgrammeLimit * (state.passes + 1)) return;
    state.ending = ZoneEnding::kConverged;
    if (coarse_) return;
    if (vertex_) return slip(state);
    if (!leave_saddle(state)) return;
  }
}

/// The smallest ball of the working points: no start is too far from it.
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

/// Distances relative to the inner radius keep their digits in a programme.
template <class Frame>
Extremes ZoneDescent<Frame>::linearise(const Frame& frame, ZoneRows<K>& rows) const {
  const Extremes zone = frame.linearise(working_, rows);
  for (double& distance : rows.distances()) distance -= zone.low;
  return zone;
}

/// Solves the programme at the state; its contacts are those of the state from now on.
template <class Frame>
auto ZoneDescent<Frame>::programme(Result& state, double box) -> ZoneStep<K> {
  const ZoneStep<K> step =
      warm_ ? program_.solve_again(rows_, box, weights_) : program_.solve(rows_, box, weights_);
  warm_ = true;
  ++state.programmes;
  state.pivots += step.pivots;
  state.outer = step.outer;
  state.inner = step.inner;
  return step;
}

/// Linear programmes inside a trust region, then Newton: to a stationary point.
template <class Frame>
void ZoneDescent<Frame>::settle(Result& state) {
  state.zone = linearise(state.frame, rows_);
  double box = std::max(10.0 * state.zone.width(), 64.0 * round_off_);
  bool rejected = false;
  int levels = 0;
  vertex_ = polished_ = false;
  const int limit = state.programmes + kProgrammeLimit;
  while (state.programmes < limit && box > round_off_) {
    const ZoneStep<K> step = programme(state, box);
    const double base = (weights_.outer - weights_.inner) * state.zone.low;
    const double promised = value(state.zone) - base - step.value;
    if (coarse_ && promised <= kCoarse * state.zone.width()) return;
    if (promised <= 2.0 * round_off_) {
      const bool level_now = step.step.cwiseAbs().maxCoeff() <= round_off_;
      vertex_ = is_vertex(step) && level_now;
      if (vertex_ || !is_vertex(step) || levels++ == kLevelLimit || !level(state, step)) break;
      continue;
    }
    // Fewer contacts than hold a vertex, or a refused step: curvature holds the rest, which a
    // linear programme cannot see; Newton can.
    if (rejected || !step.inside_box) {
      polished_ = polish(state);
      if (polished_) return;
    }
    const Frame next = state.frame.moved(step.step);
    const Extremes zone = linearise(next, trial_rows_);
    const double gained = value(state.zone) - value(zone);
    // Along a curved valley straight steps creep; Newton's go with it until another point is met.
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
    // Straight as it was, the way holds no second step worth its programme.
    if (coarse_ && step.inside_box && gained > 0.9 * promised) return;
  }
  if (!vertex_ && !coarse_) settle_by_curvature(state, box);
}

/// A contact with a small multiplier may be off its radius by more than it costs: the last steps of
/// the programme level it. @return Whether the state moved.
template <class Frame>
bool ZoneDescent<Frame>::level(Result& state, const ZoneStep<K>& step) {
  const Frame next = state.frame.moved(step.step);
  const Extremes zone = linearise(next, trial_rows_);
  if (value(zone) > value(state.zone) + 2.0 * round_off_) return false;
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
  return std::all_of(step.outer.begin(), step.outer.end(), firm) &&
         std::all_of(step.inner.begin(), step.inner.end(), firm);
}

template class ZoneDescent<CenterFrame<2>>;
template class ZoneDescent<CenterFrame<3>>;
template class ZoneDescent<CylinderFrame>;

}  // namespace rondure::fit
