#include "fit/geometry/points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/units.h"
#include "fit/geometry/internal/hull_distance.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kMostDistinct = 8;
/// Beyond 10 km a coordinate is itself rounded by more than the 1e-9 mm required of results.
constexpr double kGreatestLength = 1e7;

template <class Vector>
core::Result<void> check(std::span<const Vector> points_mm) {
  if (points_mm.empty()) return core::fail(core::Code::kNoPoints, "there are no points");
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if ((points_mm[i].array().abs() <= kGreatestLength).all()) continue;
    if (points_mm[i].allFinite()) {
      return core::fail_with(core::Code::kOutOfRange,
                             "a coordinate of point {} (counted from 0) is {:g} mm; at most {:g} "
                             "mm can be computed with",
                             i, points_mm[i].cwiseAbs().maxCoeff(), kGreatestLength);
    }
    return core::fail_with(core::Code::kNotFinite,
                           "a coordinate of point {} (counted from 0) is not a finite number", i);
  }
  return {};
}

template <class Vector>
Vector mean(std::span<const Vector> points_mm) {
  Vector sum = Vector::Zero();
  for (const Vector& p : points_mm) sum += p - points_mm.front();
  return points_mm.front() + sum / static_cast<double>(points_mm.size());
}

// Stops at `enough`, which is small: comparing with the points found so far is faster than sorting
// all of them.
template <class Vector>
std::size_t distinct(std::span<const Vector> points_mm, std::size_t enough) {
  std::array<const Vector*, kMostDistinct> found;
  assert(enough <= found.size());
  std::size_t count = 0;
  for (const Vector& p : points_mm) {
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::any_of(found.begin(), end, [&](const Vector* q) { return *q == p; })) continue;
    found[count++] = &p;
    if (count == enough) break;
  }
  return count;
}

template <class Vector>
void sample(std::span<const Vector> points_mm, std::span<Vector> out_mm) {
  assert(out_mm.size() <= points_mm.size());
  if (out_mm.size() == points_mm.size()) {
    std::ranges::copy(points_mm, out_mm.begin());
    return;
  }
  for (std::size_t k = 0; k < out_mm.size(); ++k) {
    out_mm[k] = points_mm[spread_row(k, points_mm.size())];
  }
}

}  // namespace

core::Result<void> check_points(PlanePoints points_mm) { return check(points_mm); }
core::Result<void> check_points(SpacePoints points_mm) { return check(points_mm); }
Eigen::Vector2d mean_point(PlanePoints points_mm) { return mean(points_mm); }
Eigen::Vector3d mean_point(SpacePoints points_mm) { return mean(points_mm); }
std::size_t distinct_points(PlanePoints points_mm, std::size_t enough) {
  return distinct(points_mm, enough);
}
std::size_t distinct_points(SpacePoints points_mm, std::size_t enough) {
  return distinct(points_mm, enough);
}

std::size_t spread_row(std::size_t k, std::size_t count) {
  const double place = static_cast<double>(k) / std::numbers::phi;
  // The whole part is taken by an integer conversion: without SSE 4.1 floor() is a function call.
  const double whole = static_cast<double>(static_cast<std::ptrdiff_t>(place));
  const auto row = static_cast<std::size_t>((place - whole) * static_cast<double>(count));
  return std::min(row, count - 1);
}

void sample_points(PlanePoints points_mm, std::span<Eigen::Vector2d> out_mm) {
  sample(points_mm, out_mm);
}
void sample_points(SpacePoints points_mm, std::span<Eigen::Vector3d> out_mm) {
  sample(points_mm, out_mm);
}

double largest_gap_rad(PlanePoints points_mm, const Eigen::Vector2d& center_mm) {
  // Up to 64 points use the stack, so that fits in loops allocate nothing.
  std::array<double, 64> few;
  std::vector<double> many(points_mm.size() > few.size() ? points_mm.size() : 0);
  const auto angles = many.empty() ? std::span(few).first(points_mm.size()) : std::span(many);
  std::ranges::transform(points_mm, angles.begin(), [&](const auto& p) {
    return std::atan2(p.y() - center_mm.y(), p.x() - center_mm.x());
  });
  std::ranges::sort(angles);
  double gap = angles.front() + core::kTwoPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap;
}

std::vector<Eigen::Vector2d> convex_hull(PlanePoints points_mm) {
  std::vector<Eigen::Vector2d> sorted(points_mm.begin(), points_mm.end());
  std::ranges::sort(sorted, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  // A. Andrew's chain: the lower side from left to right, the upper one back.
  std::vector<Eigen::Vector2d> hull;
  const auto turns_right = [&](const Eigen::Vector2d& next) {
    const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2];
    const Eigen::Vector2d b = next - hull.back();
    return a.x() * b.y() - a.y() * b.x() <= 0.0;
  };
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& p : sorted) {
      while (hull.size() >= first + 2 && turns_right(p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other side begins with this point
    std::ranges::reverse(sorted);
  }
  return hull;
}

double least_width(PlanePoints points_mm) {
  const auto hull = convex_hull(points_mm);
  const std::size_t n = hull.size();
  if (n < 3) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  // Corners that lie on the first edge but for rounding would hold up a search that begins there.
  std::size_t far = 1;
  for (std::size_t k = 2; k < n; ++k) {
    if (twice_area(hull[0], hull[1], hull[k]) > twice_area(hull[0], hull[1], hull[far])) far = k;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& a = hull[i];
    const Eigen::Vector2d& b = hull[(i + 1) % n];
    // The farthest corner advances round the hull with the edge.
    while (twice_area(a, b, hull[(far + 1) % n]) > twice_area(a, b, hull[far])) far = (far + 1) % n;
    least = std::min(least, twice_area(a, b, hull[far]) / (b - a).norm());
  }
  return least;
}

bool meets_hull(PlanePoints hull_mm, const Eigen::Vector2d& center_mm, double half_side_mm) {
  for (std::size_t i = 0; i < hull_mm.size(); ++i) {
    const Eigen::Vector2d& from = hull_mm[i];
    const Eigen::Vector2d side = hull_mm[(i + 1) % hull_mm.size()] - from;
    const Eigen::Vector2d out(side.y(), -side.x());
    if (out.dot(center_mm - from) > half_side_mm * out.lpNorm<1>()) return false;
  }
  return true;
}

}  // namespace rondure::fit
