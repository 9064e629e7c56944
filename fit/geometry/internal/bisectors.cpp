#include "fit/geometry/internal/bisectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

/// Bisector of two points: normal . c = offset, coordinates relative to the start.
struct Bisector {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double offset = 0.0;
};

/// Width of the zone about c, or infinity as soon as it exceeds `limit`.
double width_at(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& c,
                double limit) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const Eigen::Vector2d& p : points) {
    const double r = (p - c).norm();
    low = std::min(low, r);
    high = std::max(high, r);
    if (high - low > limit) return std::numeric_limits<double>::infinity();
  }
  return high - low;
}

/// The bisectors that pass through the disc; others cannot contain a candidate.
std::vector<Bisector> bisectors(const std::vector<Eigen::Vector2d>& points, double radius) {
  std::vector<Bisector> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Eigen::Vector2d chord = points[j] - points[i];
      const double length = chord.norm();
      if (length == 0.0) continue;
      const Bisector b{chord / length, 0.5 * (points[j] + points[i]).dot(chord) / length};
      if (std::abs(b.offset) <= radius) out.push_back(b);
    }
  }
  return out;
}

/// Least width of a strip that holds the points. One side of the best strip passes through two
/// points, so all pairs are tried: n^3 is affordable for the few points of this search.
double strip_width(const std::vector<Eigen::Vector2d>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Eigen::Vector2d along = points[j] - points[i];
      if (along.norm() == 0.0) continue;
      const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()) / along.norm();
      const auto height = [&](const auto& p) { return p.dot(normal); };
      least = std::min(least, extremes_of(points, height).width());
    }
  }
  return least;
}

/// Radius of the disc about the start that holds every centre with a zone of at most `width`;
/// infinite if a strip is as narrow.
double disc_radius(const std::vector<Eigen::Vector2d>& points, double width, double strip) {
  const Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : points) nearest = std::min(nearest, p.norm());
  const double gap = largest_gap_rad(points, origin);
  if (gap <= 120.0 * core::kDegree && width <= nearest / 20.0) {
    const double c = std::cos(0.5 * gap);
    return 2.0 * nearest * (c - std::sqrt(c * c - width / nearest));
  }
  if (!(strip > width)) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d mean = mean_point(PlanePoints(points));
  double reach = 0.0;
  for (const Eigen::Vector2d& p : points) reach = std::max(reach, (p - mean).norm());
  const double half_side = reach + reach * reach / (2.0 * (strip - width));
  return std::sqrt(2.0) * half_side + mean.norm();
}

}  // namespace

BisectorSearch search_bisectors(PlanePoints points_mm, const Eigen::Vector2d& start_mm) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& p : points_mm) points.emplace_back(p - start_mm);
  const Eigen::Vector2d origin = Eigen::Vector2d::Zero();

  BisectorSearch out;
  out.center_mm = start_mm;
  out.width_mm = width_at(points, origin, std::numeric_limits<double>::infinity());
  out.strip_mm = strip_width(points);
  // Slightly enlarged, so that round-off cannot cut off a candidate on the rim.
  const double radius = 1.000001 * disc_radius(points, out.width_mm, out.strip_mm) + 1e-12;
  const auto lines = bisectors(points, radius);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const Eigen::Vector2d& a = lines[i].normal;
      const Eigen::Vector2d& b = lines[j].normal;
      const double determinant = a.x() * b.y() - a.y() * b.x();
      if (std::abs(determinant) < 1e-14) continue;
      const Eigen::Vector2d crossing(
          (lines[i].offset * b.y() - lines[j].offset * a.y()) / determinant,
          (a.x() * lines[j].offset - b.x() * lines[i].offset) / determinant);
      if (!(crossing.squaredNorm() <= radius * radius)) continue;
      const double width = width_at(points, crossing, out.width_mm);
      if (width >= out.width_mm) continue;
      out.width_mm = width;
      out.center_mm = start_mm + crossing;
    }
  }
  out.complete = out.strip_mm > out.width_mm;
  return out;
}

}  // namespace rondure::fit
