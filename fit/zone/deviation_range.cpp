#include "fit/zone/deviation_range.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "fit/zone/internal/regions.h"

namespace rondure::fit {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr int kSquareLimit = 20000;
/// Number of nearest points that a search starts with, besides the spread ones.
constexpr std::size_t kNearest = 24;
/// Greatest distance of a profile's centres from the optimum, as a multiple of its deviation.
constexpr double kWidestSlide = 64.0;

Polygon square_about(const Eigen::Vector2d& center, double half) {
  return {center + half * Eigen::Vector2d(-1.0, -1.0), center + half * Eigen::Vector2d(1.0, -1.0),
          center + half * Eigen::Vector2d(1.0, 1.0), center + half * Eigen::Vector2d(-1.0, 1.0)};
}

/// Keeps the part of a convex polygon where normal . c <= limit.
void clip(Polygon& polygon, const Eigen::Vector2d& normal, double limit) {
  const auto excess = [&](const Eigen::Vector2d& c) { return normal.dot(c) - limit; };
  if (std::ranges::all_of(polygon, [&](const auto& c) { return excess(c) <= 0.0; })) return;
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& from = polygon[i];
    const Eigen::Vector2d& to = polygon[(i + 1) % polygon.size()];
    const double a = excess(from);
    const double b = excess(to);
    if (a <= 0.0) out.push_back(from);
    if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0))
      out.push_back(from + a / (a - b) * (to - from));
  }
  polygon = std::move(out);
}

/// Least value of a convex function between two places.
template <class Function>
double least_between(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const Function& function) {
  constexpr int kSteps = 40;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = 0.0;
  double high = 1.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    const double left = high - golden * (high - low);
    const double right = low + golden * (high - low);
    const double at_left = function(from + left * (to - from));
    const double at_right = function(from + right * (to - from));
    least = std::min({least, at_left, at_right});
    (at_left < at_right ? high : low) = at_left < at_right ? right : left;
  }
  return least;
}

/// Widens a range by the values of a convex deviation over a polygon. The greatest value is at a
/// corner. The least is sought along the longest diagonal, because the polygon is a sliver wherever
/// the range is of interest.
template <class Function>
void widen(const Polygon& polygon, const Function& deviation, DeviationRange& range) {
  std::pair<std::size_t, std::size_t> ends{0, 0};
  double longest = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double value = deviation(polygon[i]);
    range.high_mm = std::max(range.high_mm, value);
    range.low_mm = std::min(range.low_mm, value);
    for (std::size_t j = 0; j < i; ++j) {
      const double length = (polygon[i] - polygon[j]).norm();
      if (length <= longest) continue;
      longest = length;
      ends = {i, j};
    }
  }
  if (longest > 0.0) {
    range.low_mm =
        std::min(range.low_mm, least_between(polygon[ends.first], polygon[ends.second], deviation));
  }
}

std::optional<DeviationRange> of_interest(const DeviationRange& range) {
  if (!(range.high_mm - range.low_mm > kSameDeviation)) return std::nullopt;
  return range;
}

/// Searches the centres inside the hull of the points for circles as large as the largest one.
class InscribedSearcher {
 public:
  InscribedSearcher(PlanePoints points, const Eigen::Vector2d& center, double radius)
      : least_radius_(radius - kSameRadius) {
    double range = 0.0;
    for (const Eigen::Vector2d& p : points) {
      points_.emplace_back(p - center);
      range = std::max(range, points_.back().norm());
    }
    slack_ = kOutward * range;
    // In a square this small, curvature adds at most a quarter of kSameRadius.
    leaf_ = 0.5 * std::sqrt(kSameRadius * radius);
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto nearest =
        order.begin() + static_cast<std::ptrdiff_t>(std::min(kNearest, order.size()));
    std::partial_sort(order.begin(), nearest, order.end(), [&](std::size_t a, std::size_t b) {
      return points_[a].squaredNorm() < points_[b].squaredNorm();
    });
    SearchRows rows(points_.size(), {}, {});
    std::for_each(order.begin(), nearest, [&](std::size_t row) { rows.add(row); });
    for (const std::size_t row : rows.rows())
      chosen_.emplace_back(points_[row].x(), points_[row].y(), 0.0);
  }

  std::optional<DeviationRange> run() {
    const auto hull = convex_hull(points_);
    double reach = 0.0;
    for (const Eigen::Vector2d& p : hull) reach = std::max(reach, p.lpNorm<Eigen::Infinity>());
    const CenterRegion region = one_sided_region(points_, kMaximumInscribed, least_radius_ - slack_,
                                                 Eigen::Vector2d::Zero(), reach);
    const double here = deviation_at(Eigen::Vector2d::Zero());
    DeviationRange range{here, here};
    std::deque<ZoneBox> boxes{{region.center_mm, region.half_side_mm + slack_, 0.0}};
    for (int count = 0; !boxes.empty(); ++count) {
      if (count >= kSquareLimit) return std::nullopt;
      const ZoneBox box = boxes.front();
      boxes.pop_front();
      if (!meets_hull(hull, box.center_mm, box.half_side_mm)) continue;
      if (-bound_one_sided_box<2>(chosen_, box, kMaximumInscribed, slack_).lower_mm < least_radius_)
        continue;
      if (box.half_side_mm > leaf_) {
        for (const ZoneBox& quarter : quarters(box)) boxes.push_back(quarter);
        continue;
      }
      widen(
          centres_in(box), [&](const auto& c) { return deviation_at(c); }, range);
    }
    return of_interest(range);
  }

 private:
  /// Centres of a small square from which no point is nearer than the radius.
  [[nodiscard]] Polygon centres_in(const ZoneBox& box) const {
    const double half = box.half_side_mm;
    Polygon out = square_about(Eigen::Vector2d::Zero(), half);
    for (const Eigen::Vector2d& p : points_) {
      const Eigen::Vector2d v = p - box.center_mm;
      // |v - c|^2 >= r^2, with |c|^2 <= 2 half^2.
      clip(out, 2.0 * v, v.squaredNorm() + 2.0 * half * half - least_radius_ * least_radius_);
      if (out.empty()) return out;
    }
    for (Eigen::Vector2d& c : out) c += box.center_mm;
    return out;
  }

  [[nodiscard]] double deviation_at(const Eigen::Vector2d& center) const {
    const Extremes squares =
        extremes_of(points_, [&](const auto& p) { return (p - center).squaredNorm(); });
    return std::sqrt(squares.high) - std::sqrt(squares.low);
  }

  double least_radius_;
  double leaf_ = 0.0;
  double slack_ = 0.0;
  std::vector<Eigen::Vector2d> points_;  ///< Relative to the centre of the largest circle.
  std::vector<Eigen::Vector3d> chosen_;  ///< Points that the bounds use, height 0.
};

}  // namespace

std::optional<DeviationRange> deviation_range(const ZoneRows<2>& rows, const Eigen::Vector2d& step,
                                              const ZoneWeights& weights) {
  const auto [low, high] = rows.moved(step);
  Polygon polygon = square_about(step, kWidestSlide * (high - low));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (weights.outer > 0.0) {
      clip(polygon, rows.gradient(i), high + kSameRadius - rows.distances()[i]);
    } else {
      clip(polygon, -rows.gradient(i), rows.distances()[i] - low + kSameRadius);
    }
  }
  DeviationRange range{high - low, high - low};
  widen(
      polygon, [&](const Eigen::Vector2d& c) { return rows.moved(c).width(); }, range);
  return of_interest(range);
}

std::optional<DeviationRange> inscribed_deviation_range(PlanePoints points_mm,
                                                        const Eigen::Vector2d& center_mm,
                                                        double radius_mm) {
  return InscribedSearcher(points_mm, center_mm, radius_mm).run();
}

}  // namespace rondure::fit
