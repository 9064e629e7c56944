
#include "fit/zone/center_search.h"
#include "fit/geometry/internal/hull_distance.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {
namespace {

constexpr double kSameRay = 1e-12;

Eigen::Vector2d unit(PlanePoints points, const Eigen::Vector2d& center, std::size_t i) {
  return (points[i] - center).normalized();
}

/// Sets the radii and, with `pick`, the first contacts [302]: the farthest and the nearest point.
void measure(PlanePoints points, CenterSearch& search, bool pick) {
  std::size_t far = 0;
  std::size_t near = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double r = (points[i] - search.center_mm).norm();
    if (r > (points[far] - search.center_mm).norm()) far = i;
    if (r < (points[near] - search.center_mm).norm()) near = i;
  }
  search.outer_radius_mm = (points[far] - search.center_mm).norm();
  search.inner_radius_mm = (points[near] - search.center_mm).norm();
  if (!pick) return;
  search.outer = {far};
  search.inner = {near};
}

/// Direction that keeps two contacts of one side at equal distance: their bisector, of either sign.
Eigen::Vector2d bisector(const Eigen::Vector2d& first, const Eigen::Vector2d& second) {
  const Eigen::Vector2d sum = first + second;
  if (sum.norm() >= 1e-9) return sum.normalized();
  const Eigen::Vector2d chord = second - first;  // diametral; not covered by the published text
  return Eigen::Vector2d(-chord.y(), chord.x()).normalized();
}

/// Direction of the next move, [302] to [304] with corrected signs; zero where it degenerates.
Eigen::Vector2d direction(PlanePoints points, const CenterSearch& search) {
  const Eigen::Vector2d h = unit(points, search.center_mm, search.outer.front());
  const Eigen::Vector2d l = unit(points, search.center_mm, search.inner.front());
  if (search.inner.size() == 2) {
    const Eigen::Vector2d b = bisector(l, unit(points, search.center_mm, search.inner.back()));
    return h.dot(b) >= l.dot(b) ? b : Eigen::Vector2d(-b);
  }
  if (search.outer.size() == 2) {
    const Eigen::Vector2d b = bisector(h, unit(points, search.center_mm, search.outer.back()));
    return h.dot(b) >= l.dot(b) ? b : Eigen::Vector2d(-b);
  }
  const Eigen::Vector2d difference = h - l;
  if (difference.norm() <= kSameRay) return Eigen::Vector2d::Zero();
  return difference.normalized();
}

/// The chord test [305] on the unit vectors of the current contacts.
bool chords_cross(PlanePoints points, const CenterSearch& search) {
  return segments_cross(unit(points, search.center_mm, search.outer.front()),
                        unit(points, search.center_mm, search.outer.back()),
                        unit(points, search.center_mm, search.inner.front()),
                        unit(points, search.center_mm, search.inner.back()));
}

/// The fixed exchange, whatever its effect: a new inner contact replaces the second one, a new
/// outer contact the older one.
void take(CenterSearch& search, const ContactCandidate& met) {
  std::vector<std::size_t>& side = met.inner ? search.inner : search.outer;
  if (side.size() == 2) side.erase(met.inner ? side.end() - 1 : side.begin());
  side.push_back(met.index);
}

}  // namespace

core::Result<CenterSearch> center_search_as_published(PlanePoints points_mm) {
  TRY(const auto start, algebraic_circle(points_mm));
  CenterSearch out;
  out.center_mm = start.center_mm;
  measure(points_mm, out, true);
  for (int move = 0; move < kCenterMoveLimit; ++move) {
    const Eigen::Vector2d u = direction(points_mm, out);
    const auto met = u.isZero()
                         ? std::vector<ContactCandidate>()
                         : contact_candidates(points_mm, out.center_mm, u, out.outer, out.inner);
    if (met.empty()) {
      out.ending = CenterSearch::Ending::kUnbounded;
      break;
    }
    const ContactCandidate& first = met.front();
    out.moves.push_back({out.center_mm, out.width_mm(), out.outer, out.inner, u, 0.0, first});
    out.center_mm += first.step_mm * u;
    take(out, first);
    measure(points_mm, out, false);
    if (out.outer.size() < 2 || out.inner.size() < 2) continue;
    if (chords_cross(points_mm, out)) {
      out.ending = CenterSearch::Ending::kCross;
      break;
    }
    // [306] "discard H1": the newer outer contact stays, and the search continues as in [303].
    out.outer.erase(out.outer.begin());
  }
  measure(points_mm, out, false);
  return out;
}

}  // namespace rondure::fit
