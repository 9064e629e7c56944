#include "fit/zone/internal/center_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/zone/local_certificate.h"

namespace rondure::fit {
namespace {

/// Greatest distance of centres from the mean of the points, as a multiple of their extent.
constexpr double kReach = 64.0;

}  // namespace

CenterRegion center_region(PlanePoints points_mm, double width_mm) {
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

  // The proof below does not rely on the programme; it uses only its centre. Including points up to
  // `depth` off the contacts loses area but may gain growth where the contacts lie close together;
  // with all points included the growth is that of a strip.
  std::vector<double> squares;
  for (const Eigen::Vector2d& p : points_mm) squares.push_back((p - out.center_mm).squaredNorm());
  const auto [near, far] = std::minmax_element(squares.begin(), squares.end());
  const double radius = std::sqrt(*near);
  const double size = std::sqrt(*far);
  const double spare = *far - *near - width_mm * (2.0 * radius + width_mm);
  const double contact = 1e-12 * reach * reach;
  // At a distance d (max norm) a zone of at most the given width needs, for each depth,
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

CenterRegion one_sided_region(PlanePoints points_mm, const ZoneWeights& weights, double radius_mm,
                              const Eigen::Vector2d& center_mm, double half_side_mm) {
  const bool outside = weights.outer > 0.0;
  const double sign = outside ? 1.0 : -1.0;
  // The sign makes the side in question the greatest.
  std::vector<double> squares;
  for (const Eigen::Vector2d& p : points_mm)
    squares.push_back(sign * (p - center_mm).squaredNorm());
  const auto [least, most] = std::minmax_element(squares.begin(), squares.end());
  const double size = std::sqrt(std::max(std::abs(*most), std::abs(*least)));
  const double spare = sign * radius_mm * radius_mm - *most;
  const double contact = 1e-12 * size * size;
  const double unit = std::max(std::abs(spare), contact);

  /// Interval of distances (max norm) that contains no equally good centre.
  struct Gap {
    double from = 0.0;
    double to = std::numeric_limits<double>::infinity();
  };
  std::vector<Gap> gaps;
  std::vector<ContactRow<2>> touching;
  for (const double depth : {contact, unit, 4.0 * unit, 16.0 * unit, *most - *least}) {
    touching.clear();
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const Eigen::Vector2d gradient = (points_mm[i] - center_mm) / size;
      if (squares[i] >= *most - depth)
        touching.push_back({i, 0.0, gradient, Eigen::Matrix2d::Zero()});
    }
    const std::span<const ContactRow<2>> none;
    const std::span<const ContactRow<2>> side = touching;
    const double growth =
        2.0 * size * first_order_growth<2>(outside ? side : none, outside ? none : side, weights);
    // At a distance e the greatest value is at least  most - depth + growth e + e^2  on the
    // outside, where |c|^2 helps, and  most - depth + growth e - 2 e^2  on the inside, where it
    // does not.
    const double need = spare + depth;
    const double square = growth * growth + (outside ? 4.0 : -8.0) * need;
    if (outside && square < 0.0) return {CenterRegion::Kind::kEmpty, center_mm, 0.0};
    if (square <= 0.0 || (!outside && growth <= 0.0)) continue;
    const double root = std::sqrt(square);
    if (outside) {
      gaps.push_back({growth > 0.0 ? 2.0 * need / (growth + root) : 0.5 * (root - growth)});
    } else {
      gaps.push_back({2.0 * need / (growth + root), 0.25 * (growth + root)});
    }
  }
  CenterRegion out{CenterRegion::Kind::kSquare, center_mm, half_side_mm};
  for (std::size_t pass = 0; pass < gaps.size(); ++pass) {
    for (const Gap& gap : gaps) {
      if (gap.from < out.half_side_mm && gap.to > out.half_side_mm) out.half_side_mm = gap.from;
    }
  }
  if (out.half_side_mm < 0.0) out.kind = CenterRegion::Kind::kEmpty;
  return out;
}

}  // namespace rondure::fit
