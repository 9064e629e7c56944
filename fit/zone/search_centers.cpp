#include <algorithm>
#include <deque>
#include <limits>

#include "fit/geometry/points.h"
#include "fit/zone/global_search.h"
#include "fit/zone/internal/center_region.h"
#include "fit/zone/internal/search_points.h"
#include "fit/zone/internal/zone_box.h"

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

}  // namespace rondure::fit
