#include "fit/zone/global_search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "fit/geometry/points.h"
#include "fit/zone/internal/regions.h"

namespace rondure::fit {
namespace {

/// Half side of the square about the centre in which growth exceeds curvature:
/// sigma e - e^2 / (r - sqrt(2) e) > 0, with e at most r/4, where r - sqrt(2) e > 0.64 r.
double closed_half_side(double growth, double inner_radius) {
  return std::min(0.25 * inner_radius, 0.64 * growth * inner_radius);
}

class CenterSearcher {
 public:
  CenterSearcher(PlanePoints points, const Eigen::Vector2d& center, const ZoneClaim& claim,
                 const GlobalSearchOptions& options)
      : origin_(center),
        claim_(claim),
        options_(options),
        rows_(points.size(), claim.outer, claim.inner) {
    double range = 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    points_.reserve(points.size());
    for (const Eigen::Vector2d& p : points) {
      points_.emplace_back(p - center);
      nearest = std::min(nearest, points_.back().norm());
      range = std::max(range, points_.back().norm());
    }
    slack_ = kOutward * range;
    options_.tolerance_mm = std::max(options.tolerance_mm, 4.0 * slack_);
    closed_ = closed_half_side(claim.growth, nearest);
    for (const std::size_t i : rows_.rows()) take(i);
  }

  GlobalSearch<Eigen::Vector2d> run() {
    out_.lower_mm = claim_.value_mm;
    const CenterRegion region = first_region();
    if (region.kind != CenterRegion::Kind::kSquare) {
      out_.lower_mm = 0.0;
      out_.reason =
          core::Phrase("the points do not bound the centre: the narrowest zone may be a strip");
      return out_;
    }
    boxes_.push_back({region.center_mm, region.half_side_mm + slack_, 0.0});
    while (!boxes_.empty() && !out_.better) {
      if (out_.boxes >= options_.max_boxes) return give_up();
      const ZoneBox box = boxes_.front();
      boxes_.pop_front();
      visit(box);
    }
    out_.proven = !out_.better;
    return out_;
  }

 private:
  void take(std::size_t row) { chosen_.emplace_back(points_[row].x(), points_[row].y(), 0.0); }

  [[nodiscard]] bool closed_by_growth(const ZoneBox& box) const {
    return box.center_mm.cwiseAbs().maxCoeff() + box.half_side_mm <= closed_;
  }

  [[nodiscard]] bool inscribed() const { return claim_.weights.outer == 0.0; }

  /// The square that holds every centre as good as the claim.
  [[nodiscard]] CenterRegion first_region() {
    if (inscribed()) {
      hull_ = convex_hull(points_);
      double reach = 0.0;
      for (const Eigen::Vector2d& p : hull_) reach = std::max(reach, p.lpNorm<Eigen::Infinity>());
      return one_sided_region(points_, claim_.weights, -claim_.value_mm - slack_,
                              Eigen::Vector2d::Zero(), reach);
    }
    std::vector<Eigen::Vector2d> flat;
    for (const Eigen::Vector3d& p : chosen_) flat.emplace_back(p.head<2>());
    return center_region(flat, claim_.value_mm + 2.0 * slack_);
  }

  [[nodiscard]] ZoneBoxBound bound(const ZoneBox& box) const {
    if (inscribed()) return bound_one_sided_box<2>(chosen_, box, claim_.weights, slack_);
    return bound_zone_box<2>(chosen_, box, claim_.value_mm, options_.tolerance_mm, slack_);
  }

  /// Whether a box can hold a centre: that of an inscribed circle must be inside the hull.
  [[nodiscard]] bool in_hull(const ZoneBox& box) const {
    return !inscribed() || meets_hull(hull_, box.center_mm, box.half_side_mm);
  }

  void visit(const ZoneBox& box) {
    if (closed_by_growth(box) || !in_hull(box)) return;
    ++out_.boxes;
    const ZoneBoxBound found = bound(box);
    if (found.lower_mm >= claim_.value_mm - options_.tolerance_mm) {
      out_.lower_mm = std::min(out_.lower_mm, found.lower_mm);
      return;
    }
    const auto square = [&](const auto& p) { return (p - found.center_mm).squaredNorm(); };
    const ExtremeRows at = extreme_rows(points_, square, claim_.weights);
    if (at.value < claim_.value_mm - slack_ && in_hull({found.center_mm, 0.0, 0.0})) {
      out_.better = origin_ + found.center_mm;
      return;
    }
    // Points that are not yet among the chosen ones may exclude the box as it is.
    bool more = false;
    const auto look_at = [&](std::size_t row, double weight) {
      if (weight == 0.0 || !rows_.add(row)) return;
      take(row);
      more = true;
    };
    look_at(at.far, claim_.weights.outer);
    look_at(at.near, claim_.weights.inner);
    if (more) {
      boxes_.push_front(box);
    } else {
      for (const ZoneBox& quarter : quarters(box)) boxes_.push_back(quarter);
    }
  }

  GlobalSearch<Eigen::Vector2d> give_up() {
    for (const ZoneBox& box : boxes_) {
      if (!closed_by_growth(box)) out_.lower_mm = std::min(out_.lower_mm, bound(box).lower_mm);
    }
    out_.reason = left_open("squares of centres", boxes_.size(), out_.boxes, out_.lower_mm,
                            claim_.value_mm, claim_.weights);
    return out_;
  }

  Eigen::Vector2d origin_;
  ZoneClaim claim_;
  GlobalSearchOptions options_;
  SearchRows rows_;
  std::vector<Eigen::Vector2d> points_;  ///< Relative to the centre of the claim.
  std::vector<Eigen::Vector3d> chosen_;  ///< The points of rows_, height 0.
  std::vector<Eigen::Vector2d> hull_;    ///< Hull of all points, counter-clockwise; inscribed only.
  double slack_ = 0.0;
  double closed_ = 0.0;
  std::deque<ZoneBox> boxes_;
  GlobalSearch<Eigen::Vector2d> out_;
};

}  // namespace

GlobalSearch<Eigen::Vector2d> search_centers(PlanePoints points_mm,
                                             const Eigen::Vector2d& center_mm,
                                             const ZoneClaim& claim,
                                             const GlobalSearchOptions& options) {
  return CenterSearcher(points_mm, center_mm, claim, options).run();
}

namespace {

/// Boxes of directions wider than this [rad] are split at once, as their bounds would be useless.
constexpr double kWidestOpening = 0.35;
/// Times that squares of centres are quartered before the directions are.
constexpr int kSquareLevels = 6;

/// Size of the moves x = (a, b, Z tx, Z ty), |x| <= size (max norm), in which growth exceeds
/// curvature:
/// sigma e - K e^2 >= 0 with K = 4/(0.85 r) + (R + 2 sqrt(2) e)/Z^2 for e up to r/20.
double ball_size(double growth, double inner_radius, double outer_radius, double half_length) {
  const double square = 1.0 / (half_length * half_length);
  const double linear = 4.0 / (0.85 * inner_radius) + outer_radius * square;
  const double quadratic = 2.0 * std::sqrt(2.0) * square;
  const double size = std::max(growth, 0.0);
  // The root of  quadratic e^2 + linear e = sigma, in the form without cancellation.
  const double root = 2.0 * size / (linear + std::sqrt(linear * linear + 4.0 * quadratic * size));
  return std::min(root, inner_radius / 20.0);
}

class AxisSearcher {
 public:
  AxisSearcher(SpacePoints points, const Axis& axis, double half_length, const ZoneClaim& claim,
               const GlobalSearchOptions& options)
      : axis_(axis),
        half_length_(half_length),
        claim_(claim),
        options_(options),
        rows_(points.size(), claim.outer, claim.inner) {
    double range = 0.0;
    double inner = std::numeric_limits<double>::infinity();
    double outer = 0.0;
    points_.reserve(points.size());
    for (const Eigen::Vector3d& p : points) {
      points_.emplace_back(p - axis.point_mm);
      const double r = points_.back().cross(axis.direction).norm();
      inner = std::min(inner, r);
      outer = std::max(outer, r);
      range = std::max(range, points_.back().norm());
    }
    slack_ = kOutward * range;
    options_.tolerance_mm = std::max(options.tolerance_mm, 4.0 * slack_);
    ball_ = ball_size(claim.growth, inner, outer, half_length);
    for (const std::size_t i : rows_.rows()) chosen_.push_back(points_[i]);
  }

  GlobalSearch<Axis> run(std::span<const DirectionBox> directions) {
    out_.lower_mm = claim_.value_mm;
    boxes_.assign(directions.begin(), directions.end());
    while (!boxes_.empty() && !out_.better) {
      if (out_.boxes >= options_.max_boxes) return give_up();
      const DirectionBox box = boxes_.front();
      boxes_.pop_front();
      visit(box);
    }
    out_.proven = !out_.better;
    return out_;
  }

 private:
  struct View {
    Eigen::Matrix3d frame;                ///< Columns; the third is the middle of the box.
    std::vector<Eigen::Vector3d> points;  ///< The chosen points, in the frame.
    ZoneBox box;                          ///< Axes that remain.
    bool excluded = false;
    bool bounded = false;
  };

  /// Largest radial move of the chosen points when a direction of the box is turned to its middle.
  [[nodiscard]] double turning_move(const View& view, double opening) const {
    double most = 0.0;
    for (const Eigen::Vector3d& p : view.points) {
      most = std::max(most, std::abs(p.z()) * std::sin(opening) +
                                p.head<2>().norm() * (1.0 - std::cos(opening)));
    }
    return most;
  }

  /// Region of the centres whose value is not above the claim if distances change by up to `move`.
  [[nodiscard]] CenterRegion region_of(const View& view, PlanePoints flat, double move) const {
    const ZoneWeights& weights = claim_.weights;
    if (weights.outer > 0.0 && weights.inner > 0.0)
      return center_region(flat, claim_.value_mm + 2.0 * move);
    if (weights.outer > 0.0) {
      const double radius = claim_.value_mm + move;
      return one_sided_region(flat, weights, radius, Eigen::Vector2d::Zero(),
                              radius + flat.front().norm());
    }
    // Crossing of the middle of the reach, which is inclined by 10 deg at most, as the axes are.
    const Axis& about = claim_.reach.about;
    const Eigen::Vector3d point = view.frame.transpose() * (about.point_mm - axis_.point_mm);
    const Eigen::Vector3d along = view.frame.transpose() * about.direction;
    const Eigen::Vector2d crossing = (point - point.z() / along.z() * along).head<2>();
    const double limit = 1.1 * claim_.reach.limit_mm + crossing.lpNorm<Eigen::Infinity>();
    return one_sided_region(flat, weights, std::max(0.0, -claim_.value_mm - move),
                            Eigen::Vector2d::Zero(), limit);
  }

  [[nodiscard]] ZoneBoxBound bound(const View& view, const ZoneBox& square) const {
    if (claim_.weights.outer > 0.0 && claim_.weights.inner > 0.0) {
      return bound_zone_box<4>(view.points, square, claim_.value_mm, options_.tolerance_mm, slack_);
    }
    return bound_one_sided_box<4>(view.points, square, claim_.weights, slack_);
  }

  /// Projects the points along the middle of the box and bounds the centres that remain.
  [[nodiscard]] View look(const DirectionBox& box) const {
    View view;
    const Eigen::Vector3d middle = box.middle();
    view.frame << across(middle), middle;
    view.points.reserve(chosen_.size());
    std::vector<Eigen::Vector2d> flat;
    flat.reserve(chosen_.size());
    for (const Eigen::Vector3d& p : chosen_) {
      view.points.emplace_back(view.frame.transpose() * p);
      flat.emplace_back(view.points.back().head<2>());
    }
    const double opening = box.opening_rad();
    const CenterRegion region = region_of(view, flat, turning_move(view, opening) + slack_);
    view.excluded = region.kind == CenterRegion::Kind::kEmpty;
    view.bounded = region.kind == CenterRegion::Kind::kSquare;
    if (!view.bounded) return view;
    // The region holds centres of turned axes; the points where the axes themselves cross the plane
    // differ by at most |c| (sin tan + 1 - cos) <= 2 |c| tan^2.
    const double lean = std::tan(opening);
    const double farthest = region.center_mm.norm() + std::sqrt(2.0) * region.half_side_mm;
    view.box = {region.center_mm, region.half_side_mm + 2.0 * farthest * lean * lean + slack_,
                lean};
    return view;
  }

  /// Whether all axes of a box that cross a square lie in the ball of the claim.
  [[nodiscard]] bool closed_by_growth(const DirectionBox& box, const View& view,
                                      const ZoneBox& square) const {
    const double apart = view.frame.col(2).cross(axis_.direction).norm();
    if (std::abs(view.frame.col(2).dot(axis_.direction)) < 0.5) return false;
    const double angle = std::asin(std::min(1.0, apart)) + box.opening_rad();
    if (angle > 0.5 || half_length_ * std::tan(angle) > ball_) return false;
    // Crossing with the plane of the claim, along a direction inclined by `angle` at most.
    const double farthest = square.center_mm.norm() + std::sqrt(2.0) * square.half_side_mm;
    return farthest * (1.0 + apart / std::cos(angle)) <= ball_;
  }

  void visit(const DirectionBox& box) {
    if (box.opening_rad() > kWidestOpening) return split(box);
    ++out_.boxes;
    const View view = look(box);
    if (view.excluded) return;
    if (!view.bounded) return split(box);
    const auto open = first_open(box, view, view.box);
    if (!open) return;
    const ZoneBoxBound& found = *open;
    const Axis candidate = axis_of(view, found);
    if (zone_of(chosen_, candidate).value >= claim_.value_mm) return split(box);
    const ExtremeRows zone = zone_of(points_, candidate);
    if (zone.value < claim_.value_mm - slack_) {
      out_.better = Axis{candidate.point_mm + axis_.point_mm, candidate.direction};
      return;
    }
    // Points that are not yet among the chosen ones may exclude the box as it is.
    bool more = false;
    const auto take = [&](std::size_t row, double weight) {
      if (weight == 0.0 || !rows_.add(row)) return;
      chosen_.push_back(points_[row]);
      more = true;
    };
    take(zone.far, claim_.weights.outer);
    take(zone.near, claim_.weights.inner);
    if (more) {
      boxes_.push_front(box);
    } else {
      split(box);
    }
  }

  void split(const DirectionBox& box) {
    for (const DirectionBox& quarter : box.quarters()) boxes_.push_back(quarter);
  }

  /// Closes the squares of centres of a box. Splits them while they are wide compared with the move
  /// of the ends of the axis over the directions of the box; narrower squares gain nothing.
  /// @return The bound of the first square that stays open; nothing if all are closed.
  std::optional<ZoneBoxBound> first_open(const DirectionBox& box, const View& view,
                                         const ZoneBox& square, int levels = kSquareLevels) {
    if (closed_by_growth(box, view, square)) return std::nullopt;
    ++out_.boxes;
    const ZoneBoxBound found = bound(view, square);
    if (found.lower_mm >= claim_.value_mm - options_.tolerance_mm) {
      out_.lower_mm = std::min(out_.lower_mm, found.lower_mm);
      return std::nullopt;
    }
    const bool narrow = square.half_side_mm <= half_length_ * square.lean;
    if (narrow || levels == 0 || out_.boxes >= options_.max_boxes) return found;
    auto squares = quarters(square);
    // The square with the most promising axis comes first, as it is the most likely to stay open.
    std::ranges::sort(squares, [&](const ZoneBox& a, const ZoneBox& b) {
      return (a.center_mm - found.center_mm).squaredNorm() <
             (b.center_mm - found.center_mm).squaredNorm();
    });
    for (const ZoneBox& quarter : squares) {
      if (auto open = first_open(box, view, quarter, levels - 1)) return open;
    }
    return std::nullopt;
  }

  [[nodiscard]] static Axis axis_of(const View& view, const ZoneBoxBound& found) {
    Axis out;
    out.point_mm = view.frame.leftCols<2>() * found.center_mm;
    out.direction =
        (view.frame * Eigen::Vector3d(found.tilt.x(), found.tilt.y(), 1.0)).normalized();
    return out;
  }

  [[nodiscard]] ExtremeRows zone_of(SpacePoints points, const Axis& axis) const {
    const Eigen::Matrix<double, 3, 2> frame = across(axis.direction);
    const auto square = [&](const auto& p) {
      return (frame.transpose() * (p - axis.point_mm)).squaredNorm();
    };
    return extreme_rows(points, square, claim_.weights);
  }

  [[nodiscard]] double least_bound(const DirectionBox& box, const View& view) const {
    if (closed_by_growth(box, view, view.box)) return claim_.value_mm;
    return bound(view, view.box).lower_mm;
  }

  GlobalSearch<Axis> give_up() {
    for (const DirectionBox& box : boxes_) {
      const View view = look(box);
      if (view.excluded) continue;
      out_.lower_mm = view.bounded ? std::min(out_.lower_mm, least_bound(box, view)) : 0.0;
    }
    out_.reason = left_open("boxes of directions", boxes_.size(), out_.boxes, out_.lower_mm,
                            claim_.value_mm, claim_.weights);
    return out_;
  }

  Axis axis_;
  double half_length_;
  ZoneClaim claim_;
  GlobalSearchOptions options_;
  SearchRows rows_;
  std::vector<Eigen::Vector3d> points_;  ///< Relative to the point of the claimed axis.
  std::vector<Eigen::Vector3d> chosen_;  ///< The points of rows_.
  double slack_ = 0.0;
  double ball_ = 0.0;
  std::deque<DirectionBox> boxes_;
  GlobalSearch<Axis> out_;
};

}  // namespace

GlobalSearch<Axis> search_axes(SpacePoints points_mm, const Axis& axis, double half_length_mm,
                               const ZoneClaim& claim, std::span<const DirectionBox> directions,
                               const GlobalSearchOptions& options) {
  return AxisSearcher(points_mm, axis, half_length_mm, claim, options).run(directions);
}

}  // namespace rondure::fit
