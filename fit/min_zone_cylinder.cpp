#include "fit/min_zone_cylinder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "core/units.h"
#include "fit/cylinder_frame.h"
#include "fit/cylinder_start.h"
#include "fit/ls_cylinder.h"
#include "fit/points.h"

namespace rondure::fit {
namespace {

constexpr int kProgrammeLimit = 200;
constexpr int kNewtonLimit = 8;
constexpr int kSaddleLimit = 20;
constexpr std::size_t kWorkingStart = 600;  // up to here all points are the working set
constexpr std::size_t kWorkingMore = 64;    // worst points added a side and scan

using Points = std::span<const Eigen::Vector3d>;

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  [[nodiscard]] double width() const { return high - low; }
};

Extremes extremes(Points points, const CylinderFrame& frame) {
  Extremes out;
  for (const Eigen::Vector3d& p : points) {
    const double r = frame.distance(p);
    out.low = std::min(out.low, r);
    out.high = std::max(out.high, r);
  }
  return out;
}

/// Search state: the axis, its zone, and the contacts of the last programme.
struct State {
  CylinderFrame frame;
  Extremes zone;
  std::vector<Contact> outer;
  std::vector<Contact> inner;
  int programmes = 0;
};

/// The contact equations of Newton's method with the move and the multipliers as unknowns.
struct Stationarity {
  Eigen::Vector4d move = Eigen::Vector4d::Zero();
  std::vector<Contact> outer;
  std::vector<Contact> inner;
  bool valid = false;
};

Stationarity newton_step(Points points, const State& state) {
  const auto outer_count = static_cast<Eigen::Index>(state.outer.size());
  const auto count = outer_count + static_cast<Eigen::Index>(state.inner.size());
  const Eigen::Index size = 6 + count;  // move 4, two radii, multipliers
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool outer = i < outer_count;
    const Contact& contact = outer ? state.outer[static_cast<std::size_t>(i)]
                                   : state.inner[static_cast<std::size_t>(i - outer_count)];
    const auto row = state.frame.contact_row(points[contact.index], contact.index);
    const double sign = outer ? 1.0 : -1.0;
    const Eigen::Index radius = outer ? 4 : 5;
    // r + J x = H (or G)
    matrix.block<1, 4>(i, 0) = row.gradient.transpose();
    matrix(i, radius) = -1.0;
    right(i) = state.zone.low - row.distance;  // radii relative to the inner one keep their digits
    // W x + sum of signed multipliers times J = 0
    matrix.block<4, 4>(count, 0) += sign * contact.multiplier * row.hessian;
    matrix.block<4, 1>(count, 6 + i) = sign * row.gradient;
    // The multipliers of each side sum to 1.
    matrix(count + radius, 6 + i) = 1.0;
  }
  right(count + 4) = right(count + 5) = 1.0;
  const Eigen::FullPivLU<Eigen::MatrixXd> factor(matrix);
  Stationarity out;
  if (!factor.isInvertible()) return out;
  const Eigen::VectorXd solution = factor.solve(right);
  if (!solution.allFinite()) return out;
  out.move = solution.head<4>();
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool outer = i < outer_count;
    const std::size_t index = outer ? state.outer[static_cast<std::size_t>(i)].index
                                    : state.inner[static_cast<std::size_t>(i - outer_count)].index;
    (outer ? out.outer : out.inner).push_back({index, solution(6 + i)});
  }
  out.valid = true;
  return out;
}

bool all_nonnegative(const std::vector<Contact>& contacts) {
  return std::all_of(contacts.begin(), contacts.end(),
                     [](const Contact& c) { return c.multiplier >= 0.0; });
}

/// Newton on the stationarity equations of the current contacts.
/// @return Whether it settled at a zone that is not wider, with multipliers >= 0; then `state` is
/// it.
bool polish(Points points, State& state, double round_off) {
  if (state.outer.empty() || state.inner.empty()) return false;
  State trial = state;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kNewtonLimit; ++i) {
    const Stationarity next = newton_step(points, trial);
    const double size = next.move.cwiseAbs().maxCoeff();
    if (!next.valid || size > 100.0 * state.zone.width() || size > 2.0 * last) return false;
    trial.frame = trial.frame.moved(next.move);
    trial.outer = next.outer;
    trial.inner = next.inner;
    trial.zone = extremes(points, trial.frame);
    if (size <= 4.0 * round_off || (size <= 1e3 * round_off && size >= 0.5 * last)) break;
    last = size;
  }
  if (!all_nonnegative(trial.outer) || !all_nonnegative(trial.inner)) return false;
  if (!(trial.zone.width() <= state.zone.width() + 4.0 * round_off)) return false;
  // Every point must be inside the zone of the contacts: no stale contact may carry a multiplier.
  const double slack = 16.0 * round_off;
  for (const Contact& c : trial.outer) {
    if (trial.frame.distance(points[c.index]) < trial.zone.high - slack) return false;
  }
  for (const Contact& c : trial.inner) {
    if (trial.frame.distance(points[c.index]) > trial.zone.low + slack) return false;
  }
  state = trial;
  return true;
}

/// Contacts within round-off, and what they prove.
LocalProof<4> prove(Points points, const State& state, double round_off) {
  std::vector<ContactRow<4>> outer;
  std::vector<ContactRow<4>> inner;
  const double tolerance = 16.0 * round_off;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = state.frame.distance(points[i]);
    if (r >= state.zone.high - tolerance) outer.push_back(state.frame.contact_row(points[i], i));
    if (r <= state.zone.low + tolerance) inner.push_back(state.frame.contact_row(points[i], i));
  }
  return prove_local<4>(outer, inner, state.zone.width());
}

/// Linear programmes inside a trust region, then Newton: to a stationary point.
void settle(Points points, State& state, double round_off) {
  double box = 10.0 * state.zone.width();
  std::vector<ZoneRow<4>> rows(points.size());
  bool rejected = false;
  for (; state.programmes < kProgrammeLimit && box > round_off;) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      rows[i] = state.frame.row(points[i]);
      rows[i].distance -= state.zone.low;
    }
    const ZoneStep<4> step = solve_zone_program<4>(rows, box);
    ++state.programmes;
    state.outer = step.outer;
    state.inner = step.inner;
    const double promised = state.zone.width() - step.width;
    if (promised <= 2.0 * round_off) break;
    // Fewer than six contacts, or a refused step: curvature holds the rest, which a linear
    // programme cannot see; Newton can.
    if ((rejected || !step.inside_box) && polish(points, state, round_off)) return;
    const CylinderFrame next = state.frame.moved(step.step);
    const Extremes zone = extremes(points, next);
    const double gained = state.zone.width() - zone.width();
    rejected = !(gained >= 0.1 * promised);
    if (rejected) {
      box *= 0.5;
      continue;
    }
    if (gained > 0.75 * promised && !step.inside_box) box *= 2.0;
    state.frame = next;
    state.zone = zone;
  }
  polish(points, state, round_off);
}

/// Leaves a saddle along its descent, as far as that helps.
/// @return Whether the zone became narrower by more than round-off.
bool leave_saddle(Points points, State& state, const Eigen::Vector4d& descent, double round_off) {
  const State saddle = state;
  for (double size = 100.0 * saddle.zone.width(); size > 1e-6 * saddle.zone.width(); size *= 0.5) {
    for (const double sign : {1.0, -1.0}) {
      const CylinderFrame next = saddle.frame.moved(sign * size * descent);
      const Extremes zone = extremes(points, next);
      if (zone.width() >= state.zone.width()) continue;
      state.frame = next;
      state.zone = zone;
    }
  }
  return state.zone.width() < saddle.zone.width() - 2.0 * round_off;
}

/// To a local minimum. Four contacts in one section are stationary, yet a tilt may still narrow the
/// zone by its curvature: such saddles are left and the search goes on.
void descend(Points points, State& state, double round_off) {
  for (int i = 0; i < kSaddleLimit; ++i) {
    settle(points, state, round_off);
    const auto proof = prove(points, state, round_off);
    if (proof.strict || proof.descent.isZero()) return;
    if (!leave_saddle(points, state, proof.descent, round_off)) return;
  }
}

/// Adds the points that stick out of the zone farthest, spread along the data so that one bump does
/// not take all places.
bool add_violators(Points points, const State& state, double round_off,
                   std::vector<std::size_t>& working) {
  const std::size_t parts = kWorkingMore;
  const std::size_t stride = points.size() / parts + 1;
  bool added = false;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * stride;
    const std::size_t end = std::min(points.size(), begin + stride);
    std::size_t far = points.size();
    std::size_t near = points.size();
    double high = state.zone.high + round_off;
    double low = state.zone.low - round_off;
    for (std::size_t i = begin; i < end; ++i) {
      const double r = state.frame.distance(points[i]);
      if (r > high) {
        high = r;
        far = i;
      }
      if (r < low) {
        low = r;
        near = i;
      }
    }
    for (const std::size_t i : {far, near}) {
      if (i == points.size()) continue;
      working.push_back(i);
      added = true;
    }
  }
  std::sort(working.begin(), working.end());
  working.erase(std::unique(working.begin(), working.end()), working.end());
  return added;
}

std::vector<Eigen::Vector3d> pick(Points points, const std::vector<std::size_t>& rows) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(rows.size());
  for (const std::size_t i : rows) out.push_back(points[i]);
  return out;
}

/// Working-set method: minimise over some points, look at all, add those outside, repeat. The zone
/// of a subset is a lower bound, so the end is a minimum of the whole set.
void descend_large(Points points, State& state, double round_off) {
  std::vector<std::size_t> working;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kWorkingStart + 1) {
    working.push_back(i);
  }
  int programmes = 0;
  while (add_violators(points, state, round_off, working) || programmes == 0) {
    const auto some = pick(points, working);
    State part = state;
    part.programmes = 0;
    part.zone = extremes(some, part.frame);
    descend(some, part, round_off);
    for (Contact& c : part.outer) c.index = working[c.index];
    for (Contact& c : part.inner) c.index = working[c.index];
    programmes += part.programmes;
    state = part;
    if (programmes > 5 * kProgrammeLimit) break;
  }
  state.programmes = programmes;
  state.zone = extremes(points, state.frame);
}

/// Size of rounding errors of a distance: relative coordinates carry the error of the given ones.
double round_off_of(Points points_mm) {
  double size = 0.0;
  for (const Eigen::Vector3d& p : points_mm) size = std::max(size, p.cwiseAbs().maxCoeff());
  return 2.0 * std::numeric_limits<double>::epsilon() * std::max(size, 1e-3);
}

/// The data may have several local minima when they do not surround the axis or are few; then the
/// search starts from neighbouring axes too.
std::vector<CylinderFrame> starts(Points points, const CylinderFrame& best) {
  std::vector<CylinderFrame> out = {best};
  const auto frame = across(best.axis().direction);
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(frame.transpose() * p);
  const Eigen::Vector2d center = frame.transpose() * best.axis().point_mm;
  const bool full = largest_gap_rad(flat, center) <= 120.0 * core::kDegree;
  if (full && points.size() >= 12) return out;
  for (const double tilt_deg : {0.5, 2.0, 6.0}) {
    for (int k = 0; k < 8; ++k) {
      const double tilt = best.half_length_mm() * std::tan(tilt_deg * core::kDegree);
      const double angle = core::kTwoPi * k / 8.0;
      out.push_back(best.moved({0.0, 0.0, tilt * std::cos(angle), tilt * std::sin(angle)}));
    }
  }
  return out;
}

MinZoneCylinder finish(Points points, const State& state, const Eigen::Vector3d& mean,
                       double round_off) {
  MinZoneCylinder out;
  Axis axis = state.frame.axis();
  axis.point_mm += mean;
  out.axis = conventional(axis, mean);
  out.inner_radius_mm = state.zone.low;
  out.outer_radius_mm = state.zone.high;
  out.programmes = state.programmes;

  const auto proof = prove(points, state, round_off);
  out.certificate =
      certify_local<4>(proof, state.zone.width(), round_off, "next to the least-squares axis");
  out.outer = proof.outer;
  out.inner = proof.inner;
  return out;
}

}  // namespace

core::Result<MinZoneCylinder> min_zone_cylinder(
    Points points_mm, const std::optional<Eigen::Vector3d>& near_direction) {
  const auto ls = ls_cylinder(points_mm, near_direction);
  if (!ls) return core::fail(ls.error());
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  points.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) points.emplace_back(p - mean);
  const double round_off = round_off_of(points_mm);

  Axis axis = ls->axis;
  axis.point_mm -= mean;
  const CylinderFrame first(axis, std::max(half_extent(points, axis.direction), round_off));
  std::optional<State> best;
  int programmes = 0;
  for (const CylinderFrame& frame : starts(points, first)) {
    State state{frame, extremes(points, frame), {}, {}, 0};
    if (points.size() > kWorkingStart) {
      descend_large(points, state, round_off);
    } else {
      descend(points, state, round_off);
    }
    programmes += state.programmes;
    if (!best || state.zone.width() < best->zone.width()) best = state;
  }
  best->programmes = programmes;
  return finish(points, *best, mean, round_off);
}

}  // namespace rondure::fit
