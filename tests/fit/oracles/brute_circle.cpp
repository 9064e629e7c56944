#include "brute_circle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace rondure::test {
namespace {

using Points = std::vector<Vector2r>;

/// Points relative to the first: differences of doubles of one part are exact in long double.
Points local(std::span<const Eigen::Vector2d> points_mm) {
  Points out;
  for (const auto& p : points_mm) out.emplace_back(p.cast<Real>() - points_mm[0].cast<Real>());
  return out;
}

Reach reach(const Points& points, const Vector2r& center) {
  Reach out{std::numeric_limits<Real>::infinity(), 0.0L};
  for (const auto& p : points) {
    const Real r = std::hypot(p.x() - center.x(), p.y() - center.y());
    out.low_mm = std::min(out.low_mm, r);
    out.high_mm = std::max(out.high_mm, r);
  }
  return out;
}

/// A bisector: all c with normal.c = offset.
struct Line {
  Vector2r normal;
  Real offset;
};

Line bisector(const Vector2r& p, const Vector2r& q) {
  return {q - p, (q.squaredNorm() - p.squaredNorm()) / 2.0L};
}

std::optional<Vector2r> crossing(const Line& a, const Line& b) {
  const Real det = a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x();
  if (std::abs(det) <= 1e-17L * a.normal.norm() * b.normal.norm()) return std::nullopt;
  return Vector2r((a.offset * b.normal.y() - b.offset * a.normal.y()) / det,
                  (a.normal.x() * b.offset - b.normal.x() * a.offset) / det);
}

std::vector<Line> bisectors(const Points& points) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (points[i] != points[j]) lines.push_back(bisector(points[i], points[j]));
    }
  }
  return lines;
}

/// Calls visit(centre) for every circle through three points.
template <class Visit>
void for_triples(const Points& points, const Visit& visit) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        if (points[i] == points[j] || points[j] == points[k] || points[i] == points[k]) continue;
        const auto center =
            crossing(bisector(points[i], points[j]), bisector(points[j], points[k]));
        if (center) visit(*center);
      }
    }
  }
}

/// True when the nearest points, seen from the centre, leave no gap of 180 deg.
bool held(const Points& points, const Vector2r& center, Real low) {
  std::vector<Real> angles;
  for (const auto& p : points) {
    const Vector2r v = p - center;
    if (v.norm() <= low + 1e-13L) angles.push_back(std::atan2(v.y(), v.x()));
  }
  std::sort(angles.begin(), angles.end());
  Real gap = angles.front() + 2.0L * std::numbers::pi_v<Real> - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
  return gap < std::numbers::pi_v<Real> - 1e-9L;
}

}  // namespace

Reach reach_from(std::span<const Eigen::Vector2d> points_mm, const Vector2r& center_mm) {
  return reach(local(points_mm), center_mm - points_mm[0].cast<Real>());
}

CirclePlace brute_min_zone(std::span<const Eigen::Vector2d> points_mm) {
  const Points points = local(points_mm);
  const std::vector<Line> lines = bisectors(points);
  CirclePlace best{Vector2r::Zero(), std::numeric_limits<Real>::infinity()};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const auto center = crossing(lines[i], lines[j]);
      if (!center) continue;
      const Reach at = reach(points, *center);
      if (at.high_mm - at.low_mm < best.value_mm) best = {*center, at.high_mm - at.low_mm};
    }
  }
  best.center_mm += points_mm[0].cast<Real>();
  return best;
}

Real brute_strip(std::span<const Eigen::Vector2d> points_mm) {
  const Points points = local(points_mm);
  Real best = std::numeric_limits<Real>::infinity();
  for (const Line& line : bisectors(points)) {
    const Vector2r across = Vector2r(-line.normal.y(), line.normal.x()).normalized();
    Real low = 0.0L;  // the first point is the origin
    Real high = 0.0L;
    for (const auto& p : points) {
      low = std::min(low, across.dot(p));
      high = std::max(high, across.dot(p));
    }
    best = std::min(best, high - low);
  }
  return best;
}

CirclePlace brute_circumscribed(std::span<const Eigen::Vector2d> points_mm) {
  const Points points = local(points_mm);
  CirclePlace best{Vector2r::Zero(), std::numeric_limits<Real>::infinity()};
  const auto visit = [&](const Vector2r& center) {
    const Real radius = reach(points, center).high_mm;
    if (radius < best.value_mm) best = {center, radius};
  };
  for (const auto& p : points) {
    for (const auto& q : points) visit((p + q) / 2.0L);
  }
  for_triples(points, visit);
  best.center_mm += points_mm[0].cast<Real>();
  return best;
}

std::vector<CirclePlace> brute_inscribed(std::span<const Eigen::Vector2d> points_mm) {
  const Points points = local(points_mm);
  std::vector<CirclePlace> maxima;
  for_triples(points, [&](const Vector2r& center) {
    const Real low = reach(points, center).low_mm;
    // An empty circle through three points: they are the nearest ones.
    int contacts = 0;
    for (const auto& p : points) contacts += (p - center).norm() <= low + 1e-13L ? 1 : 0;
    if (contacts < 3 || !held(points, center, low)) return;
    const Vector2r place = center + points_mm[0].cast<Real>();
    const bool known = std::any_of(maxima.begin(), maxima.end(), [&](const CirclePlace& m) {
      return (m.center_mm - place).norm() < 1e-11L;
    });
    if (!known) maxima.push_back({place, low});
  });
  return maxima;
}

}  // namespace rondure::test
