#include "fit/zone/center_search.h"

#include <algorithm>
#include <array>
#include <limits>

#include "fit/geometry/internal/hull_distance.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {
namespace {

constexpr double kContactTolerance = 1e-9;  // tau_c [mm]
constexpr double kGapTolerance = 1e-9;      // tau_g
/// A point nearer than this is in contact already; round-off alone decides on which side it lies.
constexpr double kLeastStep = 1e-9;  // mm

/// Extreme distances of all points from a centre, and the contacts there.
struct ContactSets {
  double low = 0.0;
  double high = 0.0;
  std::vector<std::size_t> outer;
  std::vector<std::size_t> inner;
};

/// Returns tau_c, raised if the coordinates are so large that 1e-9 mm is round-off.
double contact_tolerance(PlanePoints points_mm) {
  Eigen::Vector2d low = points_mm.front();
  Eigen::Vector2d high = points_mm.front();
  for (const Eigen::Vector2d& p : points_mm) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double range = (high - low).maxCoeff();
  const double size = std::max(high.cwiseAbs().maxCoeff(), low.cwiseAbs().maxCoeff());
  return std::max(
      {kContactTolerance, 1e-13 * range, 16.0 * std::numeric_limits<double>::epsilon() * size});
}

ContactSets contacts_at(PlanePoints points_mm, const Eigen::Vector2d& center, double tolerance) {
  ContactSets out;
  std::vector<double> r(points_mm.size());
  std::ranges::transform(points_mm, r.begin(),
                         [&](const Eigen::Vector2d& p) { return (p - center).norm(); });
  const auto [low, high] = std::minmax_element(r.begin(), r.end());
  out.low = *low;
  out.high = *high;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (r[i] >= out.high - tolerance) out.outer.push_back(i);
    if (r[i] <= out.low + tolerance) out.inner.push_back(i);
  }
  return out;
}

std::vector<Eigen::Vector2d> directions(PlanePoints points_mm, const Eigen::Vector2d& center,
                                        std::span<const std::size_t> rows) {
  std::vector<Eigen::Vector2d> out;
  for (const std::size_t i : rows) out.emplace_back((points_mm[i] - center).normalized());
  return out;
}

}  // namespace

std::vector<ContactCandidate> contact_candidates(PlanePoints points_mm,
                                                 const Eigen::Vector2d& center_mm,
                                                 const Eigen::Vector2d& direction,
                                                 std::span<const std::size_t> outer,
                                                 std::span<const std::size_t> inner) {
  const auto along = [&](std::size_t i) { return (points_mm[i] - center_mm).dot(direction); };
  // Contacts that stay extreme during the move: the outer one recedes most, the inner one least.
  const auto by_along = [&](std::size_t a, std::size_t b) { return along(a) < along(b); };
  const std::size_t h = *std::ranges::min_element(outer, by_along);
  const std::size_t l = *std::ranges::max_element(inner, by_along);
  // The difference of squared distances as (a - b).(a + b), which avoids cancellation.
  const auto squared_difference = [&](std::size_t a, std::size_t b) {
    return (points_mm[a] - points_mm[b])
        .dot((points_mm[a] - center_mm) + (points_mm[b] - center_mm));
  };
  const auto holds = [](std::span<const std::size_t> set, std::size_t i) {
    return std::ranges::find(set, i) != set.end();
  };
  std::vector<ContactCandidate> out;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const double q = along(i);
    if (!holds(outer, i) && q < along(h)) {
      const double step = squared_difference(h, i) / (2.0 * (along(h) - q));
      if (step > kLeastStep) out.push_back({i, false, step});
    }
    if (!holds(inner, i) && q > along(l)) {
      const double step = squared_difference(i, l) / (2.0 * (q - along(l)));
      if (step > kLeastStep) out.push_back({i, true, step});
    }
  }
  std::ranges::stable_sort(out, {}, &ContactCandidate::step_mm);
  return out;
}

core::Result<CenterSearch> center_search(PlanePoints points_mm) {
  TRY(const auto start, algebraic_circle(points_mm));
  const double tolerance = contact_tolerance(points_mm);
  CenterSearch out;
  out.center_mm = start.center_mm;
  for (int move = 0; move <= kCenterMoveLimit; ++move) {
    const ContactSets now = contacts_at(points_mm, out.center_mm, tolerance);
    out.inner_radius_mm = now.low;
    out.outer_radius_mm = now.high;
    out.outer = now.outer;
    out.inner = now.inner;
    if (now.high - now.low <= tolerance) {
      out.ending = CenterSearch::Ending::kCoCircular;
      return out;
    }
    const auto gap = hull_distance(directions(points_mm, out.center_mm, now.outer),
                                   directions(points_mm, out.center_mm, now.inner));
    if (gap.distance <= kGapTolerance) {
      out.ending = gap.vertices ? CenterSearch::Ending::kSpoke : CenterSearch::Ending::kCross;
      return out;
    }
    if (move == kCenterMoveLimit) break;
    const Eigen::Vector2d direction = (gap.on_first - gap.on_second) / gap.distance;
    const auto met = contact_candidates(points_mm, out.center_mm, direction, now.outer, now.inner);
    if (met.empty()) {
      out.ending = CenterSearch::Ending::kUnbounded;
      return out;
    }
    out.moves.push_back({out.center_mm, now.high - now.low, now.outer, now.inner, direction,
                         gap.distance, met.front()});
    out.center_mm += met.front().step_mm * direction;
  }
  out.ending = CenterSearch::Ending::kMoveLimit;
  return out;
}

}  // namespace rondure::fit
