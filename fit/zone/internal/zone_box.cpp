#include "fit/zone/internal/zone_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondure::fit {
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

}  // namespace rondure::fit
