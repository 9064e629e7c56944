#include "fit/zone/internal/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "fit/geometry/points.h"
#include "fit/zone/local_certificate.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kSpread = 60;

}  // namespace

SearchRows::SearchRows(std::size_t count, std::span<const Contact> outer,
                       std::span<const Contact> inner)
    : taken_(count, false) {
  for (const Contact& c : outer) add(c.index);
  for (const Contact& c : inner) add(c.index);
  if (count <= kSpread + 4) {
    for (std::size_t i = 0; i < count; ++i) add(i);
    return;
  }
  for (std::size_t k = 0; k < kSpread; ++k) add(spread_row(k, count));
}

bool SearchRows::add(std::size_t row) {
  if (taken_[row]) return false;
  taken_[row] = true;
  rows_.push_back(row);
  return true;
}

core::Phrase left_open(std::string_view boxes, std::size_t left, int after, double lower_mm,
                       double value_mm, const ZoneWeights& weights) {
  const bool inside = weights.outer == 0.0;
  return core::Phrase(fmt::format(
      "{} {} were left after {}; {} bound {:.9g} mm, {:.3g} mm from the value found", left, boxes,
      after, inside ? "upper" : "lower", inside ? -lower_mm : lower_mm, value_mm - lower_mm));
}

namespace {

constexpr int kBisections = 10;

/// Weak duality for one box: the multipliers of its programme, and the bounds that they prove.
class BoxProof {
 public:
  BoxProof(SpacePoints points, const ZoneBox& box, double guess_radius, const Contacts& outer,
           const Contacts& inner)
      : points_(points), box_(box), radius_(guess_radius), outer_(outer), inner_(inner) {
    normalise(outer_);
    normalise(inner_);
  }

  /// Whether every axis of the box has a zone wider than `width`, with a margin of `slack`.
  [[nodiscard]] bool proves(double width, double slack) const {
    if (outer_.empty() || inner_.empty()) return false;
    const double asked = width + slack;
    return least_sum(1.0, 1.0 + asked / radius_) > asked * (radius_ + asked) + slack * radius_;
  }

  /// Lower bound of  outer * max r^2 - inner * min r^2  over the box, where one factor is 0.
  [[nodiscard]] double one_side(const ZoneWeights& weights, double slack) const {
    if (outer_.empty() == (weights.outer > 0.0) || inner_.empty() == (weights.inner > 0.0))
      return -std::numeric_limits<double>::infinity();
    double size = 0.0;
    for (const Contact& c : outer_) size = std::max(size, points_[c.index].norm());
    for (const Contact& c : inner_) size = std::max(size, points_[c.index].norm());
    return least_sum(weights.outer, weights.inner) - slack * (size + box_.center_mm.norm());
  }

 private:
  static void normalise(Contacts& side) {
    double sum = 0.0;
    for (const Contact& c : side) sum += c.multiplier;
    for (Contact& c : side) c.multiplier /= sum;
  }

  /// Lower bound over the box of  outer * max r^2 - inner * min r^2.
  [[nodiscard]] double least_sum(double outer, double inner) const {
    Sums sums;
    add(outer_, outer, sums);
    add(inner_, -inner, sums);
    const double h = box_.half_side_mm;
    const double t = box_.lean;
    double least = sums.constant - h * sums.across.lpNorm<1>() - t * sums.tilt.norm();
    // |o|^2 does not cancel if the multipliers of the two sides differ.
    double quadratic = std::min(0.0, outer - inner) * 2.0 * h * h;
    quadratic -= 2.0 * std::abs(sums.heights) * std::sqrt(2.0) * h * t;
    quadratic += std::min(0.0, least_eigenvalue(sums.quadratic)) * t * t;
    if (inner == 0.0) {  // |o + s t|^2 is not negative as a whole
      const Eigen::Matrix2d leant = sums.quadratic - sums.squares * Eigen::Matrix2d::Identity();
      quadratic = std::max(quadratic, std::min(0.0, least_eigenvalue(leant)) * t * t);
    }
    return least + quadratic - sums.rest;
  }

  /// Terms of the weighted sum of r^2 as a function of the axis.
  struct Sums {
    double constant = 0.0;
    Eigen::Vector2d across = Eigen::Vector2d::Zero();     ///< Linear in the crossing point.
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero();       ///< Linear in the tilt.
    double heights = 0.0;                                 ///< Half the factor of o.t.
    double squares = 0.0;                                 ///< Sum of the squared heights.
    Eigen::Matrix2d quadratic = Eigen::Matrix2d::Zero();  ///< Quadratic in the tilt.
    double rest = 0.0;                                    ///< Bound of third and higher orders.
  };

  void add(const Contacts& side, double sign, Sums& sums) const {
    const double t = box_.lean;
    for (const Contact& contact : side) {
      const Eigen::Vector3d& point = points_[contact.index];
      const Eigen::Vector2d p = point.head<2>() - box_.center_mm;
      const double s = point.z();
      const double c = sign * contact.multiplier;
      sums.constant += c * p.squaredNorm();
      sums.across -= 2.0 * c * p;
      if (t == 0.0) continue;
      sums.tilt -= 2.0 * c * s * p;
      sums.heights += c * s;
      sums.squares += c * s * s;
      sums.quadratic += c * (s * s * Eigen::Matrix2d::Identity() - p * p.transpose());
      const double moved = std::sqrt(2.0) * box_.half_side_mm * t + std::abs(s) * t * t;
      const double lean = p.norm() * t;
      const double most = lean + moved;
      sums.rest += std::abs(c) * (2.0 * lean * moved + moved * moved + most * most * t * t);
    }
  }

  static double least_eigenvalue(const Eigen::Matrix2d& m) {
    const double middle = 0.5 * (m(0, 0) + m(1, 1));
    return middle - std::hypot(0.5 * (m(0, 0) - m(1, 1)), m(0, 1));
  }

  SpacePoints points_;
  ZoneBox box_;
  double radius_;
  Contacts outer_;
  Contacts inner_;
};

}  // namespace

std::array<ZoneBox, 4> quarters(const ZoneBox& box) {
  const double half = 0.5 * box.half_side_mm;
  const auto quarter = [&](double x, double y) -> ZoneBox {
    return {box.center_mm + Eigen::Vector2d(x, y), half, box.lean};
  };
  return {quarter(-half, -half), quarter(-half, half), quarter(half, -half), quarter(half, half)};
}

namespace {

/// The linear part of r^2 over a box; the unknowns are in [-1, 1].
template <int K>
ZoneRows<K> linear_rows(SpacePoints points, const ZoneBox& box) {
  ZoneRows<K> rows;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector2d p = point.head<2>() - box.center_mm;
    Eigen::Matrix<double, K, 1> gradient;
    gradient.template head<2>() = -2.0 * box.half_side_mm * p;
    if constexpr (K == 4) gradient.template tail<2>() = -2.0 * point.z() * box.lean * p;
    rows.push_back(p.squaredNorm(), gradient);
  }
  return rows;
}

/// The axis of the box at which the programme has its optimum.
template <int K>
ZoneBoxBound preferred(const ZoneBox& box, const ZoneStep<K>& step) {
  ZoneBoxBound out;
  out.center_mm = box.center_mm + box.half_side_mm * step.step.template head<2>();
  if constexpr (K == 4) out.tilt = box.lean * step.step.template tail<2>();
  return out;
}

}  // namespace

template <int K>
ZoneBoxBound bound_one_sided_box(SpacePoints points_mm, const ZoneBox& box,
                                 const ZoneWeights& weights, double slack_mm) {
  const auto step =
      solve_zone_program<K>(linear_rows<K>(points_mm, box), 1.0, weights, kBoundPivotLimit);
  ZoneBoxBound out = preferred(box, step);
  const BoxProof proof(points_mm, box, 0.0, step.outer, step.inner);
  const double least = proof.one_side(weights, slack_mm);
  out.lower_mm = least > 0.0 ? std::sqrt(least) : -std::sqrt(-least);
  if (weights.outer > 0.0) out.lower_mm = std::max(out.lower_mm, 0.0);
  return out;
}

template <int K>
ZoneBoxBound bound_zone_box(SpacePoints points_mm, const ZoneBox& box, double width_mm,
                            double tolerance_mm, double slack_mm) {
  const ZoneRows<K> rows = linear_rows<K>(points_mm, box);
  const double nearest = *std::min_element(rows.distances().begin(), rows.distances().end());
  // Any radius is valid; that of the data gives the sharpest bound.
  const double radius = std::max(std::sqrt(nearest), width_mm);
  const auto step =
      solve_zone_program<K>(rows, 1.0, {1.0, 1.0 + width_mm / radius}, kBoundPivotLimit);

  ZoneBoxBound out = preferred(box, step);
  const BoxProof proof(points_mm, box, radius, step.outer, step.inner);
  if (proof.proves(width_mm, slack_mm)) {
    out.lower_mm = width_mm;
    return out;
  }
  double high = width_mm;
  // Near the stated width every digit counts; far below it a few are enough.
  if (proof.proves(width_mm - tolerance_mm, slack_mm)) out.lower_mm = width_mm - tolerance_mm;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (out.lower_mm + high);
    (proof.proves(middle, slack_mm) ? out.lower_mm : high) = middle;
  }
  return out;
}

template ZoneBoxBound bound_zone_box<2>(SpacePoints, const ZoneBox&, double, double, double);
template ZoneBoxBound bound_zone_box<4>(SpacePoints, const ZoneBox&, double, double, double);
template ZoneBoxBound bound_one_sided_box<2>(SpacePoints, const ZoneBox&, const ZoneWeights&,
                                             double);
template ZoneBoxBound bound_one_sided_box<4>(SpacePoints, const ZoneBox&, const ZoneWeights&,
                                             double);

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
