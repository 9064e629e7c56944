#include "fit/center_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/local_certificate.h"
#include "fit/points.h"
#include "fit/zone_program.h"

namespace rondure::fit {
namespace {

/// Centres are sought up to this many times the extent of the points from their mean.
constexpr double kReach = 64.0;

}  // namespace

CenterRegion center_region(std::span<const Eigen::Vector2d> points_mm, double width_mm) {
  const Eigen::Vector2d mean = mean_point(points_mm);
  double reach = 0.0;
  for (const Eigen::Vector2d& p : points_mm) reach = std::max(reach, (p - mean).norm());
  CenterRegion out;
  if (reach == 0.0) return out;
  ZoneRows<2> rows;
  for (const Eigen::Vector2d& p : points_mm) {
    const Eigen::Vector2d v = p - mean;
    rows.push_back(v.squaredNorm(), -2.0 * reach * v);
  }
  const auto least = solve_zone_program<2>(rows, kReach, kMinimumZone, kBoundPivotLimit);
  out.center_mm = mean + reach * least.step;

  // From here on the programme is not trusted: only its centre is used. Points up to `depth` off
  // the contacts lose area but may gain growth, where the contacts themselves lie close together;
  // with all points the growth is that of a strip.
  std::vector<double> squares;
  for (const Eigen::Vector2d& p : points_mm) squares.push_back((p - out.center_mm).squaredNorm());
  const auto [near, far] = std::minmax_element(squares.begin(), squares.end());
  const double radius = std::sqrt(*near);
  const double size = std::sqrt(*far);
  const double spare = *far - *near - width_mm * (2.0 * radius + width_mm);
  const double contact = 1e-12 * reach * reach;
  // At a distance d (max norm) a zone as narrow as asked for needs, for each depth,
  //     spare - 2 depth + growth d <= 0.
  double least_distance = 0.0;
  double most_distance = std::numeric_limits<double>::infinity();
  for (const double depth : {0.45 * spare, contact, 0.5 * width_mm * radius,
                             4.0 * width_mm * radius, 32.0 * width_mm * radius, *far - *near}) {
    if (depth < contact) continue;
    std::vector<ContactRow<2>> outer;
    std::vector<ContactRow<2>> inner;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const Eigen::Vector2d gradient = (points_mm[i] - out.center_mm) / size;
      if (squares[i] >= *far - depth) outer.push_back({i, 0.0, gradient, Eigen::Matrix2d::Zero()});
      if (squares[i] <= *near + depth) inner.push_back({i, 0.0, gradient, Eigen::Matrix2d::Zero()});
    }
    const double growth =
        2.0 * size * first_order_growth<2>(outer, inner) - 2.0 * std::sqrt(2.0) * width_mm;
    const double excess = 2.0 * depth - spare;
    if (growth > 0.0) {
      most_distance = std::min(most_distance, excess / growth);
    } else if (growth < 0.0) {
      least_distance = std::max(least_distance, excess / growth);
    }
    if (least_distance > most_distance) {
      out.kind = CenterRegion::Kind::kEmpty;
      return out;
    }
  }
  if (std::isinf(most_distance)) return out;
  out.kind = CenterRegion::Kind::kSquare;
  out.half_side_mm = most_distance;
  return out;
}

}  // namespace rondure::fit
