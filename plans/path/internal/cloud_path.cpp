#include "plans/path/internal/cloud_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/path/internal/detour.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kCompared = 2000;  // targets up to which two orders are compared
constexpr double kFarthest_mm = 200.0;   // limit of the paths around further out
constexpr double kHair_mm = 1e-9;

Way backward(Way way) {
  std::reverse(way.corners.begin(), way.corners.end());
  std::reverse(way.phases.begin(), way.phases.end());
  return way;
}

/// Two paths, joined by a straight move.
Way joined(Way first, const Way& second, Phase across) {
  first.phases.push_back(across);
  first.corners.insert(first.corners.end(), second.corners.begin(), second.corners.end());
  first.phases.insert(first.phases.end(), second.phases.begin(), second.phases.end());
  return first;
}

/// The geometry with room beyond the upper end for a part that points down, if only by how a lying
/// one was found: the tip that comes straight down beyond that end nears the end face again.
PathGeometry beyond_end(PathGeometry geometry, const Placement& placement) {
  const double up = placement.X_WP.linear()(2, 2);
  if (geometry.inside || up >= 0.0) return geometry;
  constexpr double kPolygon = 1.01;  // the path around is a polygon
  const double across_mm = 2.0 * kPolygon *
                           (geometry.radius_mm + geometry.tip_radius_mm + geometry.stand_off_mm +
                            std::max(geometry.approach_mm, geometry.clearance_mm));
  const double level = std::sqrt(std::max(0.0, 1.0 - up * up));
  geometry.to_mm += level > 0.0 ? std::min(kFarthest_mm, across_mm * -up / level) : kFarthest_mm;
  return geometry;
}

}  // namespace

CloudPath::CloudPath(const Scene& scene, const Placement& placement, const PathGeometry& geometry,
                     double sky_mm, std::vector<Target> targets, std::vector<std::size_t> proposed,
                     std::size_t detour_moves)
    : scene_(&scene),
      placement_(placement),
      geometry_(beyond_end(geometry, placement)),
      further_(geometry_),
      sky_mm_(sky_mm),
      targets_(std::move(targets)) {
  further_.stand_off_mm += further_mm();
  find_entries(detour_moves);
  if (unreachable_.empty()) choose_order(std::move(proposed));
}

/// Largest overhang of a vertical shaft over a part that is not upright.
double CloudPath::further_mm() const {
  const Tool& tool = scene_->tool();
  if (tool.shaft_length_mm <= 0.0 || geometry_.inside) return 0.0;
  const double cosine = std::abs(placement_.X_WP.linear()(2, 2));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double height_mm = std::min(tool.shaft_length_mm, geometry_.to_mm - geometry_.from_mm);
  const double lean_mm = cosine > 0.0 ? height_mm * sine / cosine : kFarthest_mm;
  const double thicker_mm = std::max(
      {0.0, tool.shaft_radius_mm - tool.tip_radius_mm, tool.holder_radius_mm - tool.tip_radius_mm});
  return std::min(kFarthest_mm, lean_mm + thicker_mm);
}

/// In a bore every wall is close, on a plane the shaft that rises from it.
bool CloudPath::beside_walls() const {
  return geometry_.inside ||
         (geometry_.surface && geometry_.surface->shape() == record::Shape::kPlane);
}

Way CloudPath::in_machine(const Polyline& path_P, Phase first, Phase middle, Phase last) const {
  Way out;
  for (const Vector3d& corner : path_P) out.corners.emplace_back(placement_.X_WP * corner);
  out.phases.assign(path_P.size() - 1, middle);
  out.phases.front() = first;
  out.phases.back() = last;
  return out;
}

Way CloudPath::entry(std::size_t target, Entry kind) const {
  if (kind == Entry::kDetour) return detours_.at(target);
  const Target& t = targets_[target];
  const bool wide = kind == Entry::kAlongAxisFurther || kind == Entry::kVerticalFurther;
  const PathGeometry& g = wide ? further_ : geometry_;
  const Polyline along = entry_path(g, t);
  Way out;
  if (kind == Entry::kAlongAxis || kind == Entry::kAlongAxisFurther) {
    out = in_machine(along, beside_walls() ? Phase::kNear : Phase::kTravel, Phase::kNear,
                     Phase::kNear);
  } else {
    out = in_machine({along.begin() + 1, along.end()}, Phase::kNear, Phase::kNear, Phase::kNear);
  }
  // Moves sideways only at park height; then straight down.
  Vector3d above = out.corners.front();
  above.z() = std::max(above.z(), sky_mm_);
  out.corners.insert(out.corners.begin(), above);
  out.phases.insert(out.phases.begin(), Phase::kTravel);
  return out;
}

Way CloudPath::touch_way(std::size_t target) const {
  const Target& t = targets_[target];
  return in_machine({pre_touch(geometry_, t), contact_tip(geometry_, t)}, Phase::kTouch,
                    Phase::kTouch, Phase::kTouch);
}

void CloudPath::find_entries(std::size_t detour_moves) {
  std::vector<Entry> kinds = {Entry::kAlongAxis};
  const bool further = further_.stand_off_mm > geometry_.stand_off_mm + kHair_mm;
  if (further) kinds.push_back(Entry::kAlongAxisFurther);
  if (!geometry_.inside) kinds.push_back(Entry::kVertical);
  if (!geometry_.inside && further) kinds.push_back(Entry::kVerticalFurther);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    bool barred = false;
    std::optional<Hit> hit = scene_->first_hit(touch_way(i), placement_, geometry_);
    std::optional<Entry> found;
    for (const Entry kind : kinds) {
      if (found || (hit && kind == kinds.front())) break;
      const auto on_entry = scene_->first_hit(entry(i, kind), placement_, geometry_);
      if (!on_entry) found = kind;
      barred |= on_entry && on_entry->body == Body::kBody;
      if (!hit) hit = on_entry;
    }
    if (!found && barred && unreachable_.empty()) {  // otherwise the cloud is refused as it is
      const Vector3d start = placement_.X_WP * pre_touch(geometry_, targets_[i]);
      if (auto way = detour(*scene_, placement_, geometry_, start, sky_mm_, detour_moves)) {
        detours_[i] = *std::move(way);
        found = Entry::kDetour;
      }
    }
    if (!found) unreachable_.push_back({targets_[i], *hit});
    entries_.push_back(found.value_or(kinds.front()));
  }
}

Way CloudPath::over_the_end(std::size_t from, std::size_t to) const {
  if (geometry_.inside) {
    const Polyline in = entry_path(geometry_, targets_[to]);
    const Polyline out = entry_path(geometry_, targets_[from]);
    return in_machine({out[2], out[1], in[1], in[2]}, Phase::kNear, Phase::kNear, Phase::kNear);
  }
  Way down = entry(to, entries_[to]);
  Way up = backward(entry(from, entries_[from]));
  // Removes the corners in the sky; a vertical entry has no corner above the end.
  const auto drop_sky = [](Way& way, bool front) {
    way.corners.erase(front ? way.corners.begin() : way.corners.end() - 1);
    way.phases.erase(front ? way.phases.begin() : way.phases.end() - 1);
  };
  drop_sky(down, true);
  drop_sky(up, false);
  return joined(std::move(up), down, Phase::kTravel);
}

Way CloudPath::between(std::size_t from, std::size_t to) const {
  const Phase middle = beside_walls() ? Phase::kNear : Phase::kTravel;
  const auto around = [&](const PathGeometry& g) {
    return in_machine(path_between(g, targets_[from], targets_[to]), Phase::kNear, middle,
                      Phase::kNear);
  };
  std::vector<Way> ways = {around(geometry_)};
  if (further_.stand_off_mm > geometry_.stand_off_mm + kHair_mm) ways.push_back(around(further_));
  const bool along_axis =
      entries_[from] <= Entry::kAlongAxisFurther && entries_[to] <= Entry::kAlongAxisFurther;
  if (along_axis) ways.push_back(over_the_end(from, to));
  std::stable_sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) {
    return length_mm(a.corners) < length_mm(b.corners) - kHair_mm;
  });
  for (Way& way : ways) {
    if (!scene_->first_hit(way, placement_, geometry_)) return std::move(way);
  }
  return joined(backward(entry(from, entries_[from])), entry(to, entries_[to]), Phase::kTravel);
}

double CloudPath::tour_mm(const std::vector<std::size_t>& order) const {
  double sum = length_mm(entry(order.front(), entries_[order.front()]).corners) +
               length_mm(entry(order.back(), entries_[order.back()]).corners);
  for (std::size_t k = 1; k < order.size(); ++k) {
    sum += length_mm(between(order[k - 1], order[k]).corners);
  }
  return sum;
}

void CloudPath::choose_order(std::vector<std::size_t> proposed) {
  order_ = std::move(proposed);
  std::vector<std::size_t> own(targets_.size());
  std::iota(own.begin(), own.end(), std::size_t{0});
  if (order_ == own || targets_.size() > kCompared) return;
  if (tour_mm(own) < tour_mm(order_)) order_ = std::move(own);
}

Polyline CloudPath::entry_W(std::size_t k) const {
  return entry(order_[k], entries_[order_[k]]).corners;
}

Polyline CloudPath::way_W(std::size_t k) const {
  return k == 0 ? entry_W(0) : between(order_[k - 1], order_[k]).corners;
}

Polyline CloudPath::exit_W(std::size_t k) const {
  Polyline out = entry_W(k);
  std::reverse(out.begin(), out.end());
  return out;
}

FeaturePlanner::FeaturePlanner(const Plan& plan, const FeaturePlan& feature)
    : plan_(plan), feature_(feature), scene_(plan, feature) {}

core::Result<CloudPath> FeaturePlanner::lay(const std::vector<Target>& targets,
                                            const PathGeometry& geometry,
                                            const Eigen::Isometry3d& X_WB,
                                            const Eigen::Isometry3d& X_BP) {
  TRY_DO(check_clamp(targets, geometry, *plan_.fixture));
  if (ordered_ != targets || !(ordered_geometry_ == geometry)) {
    order_ = short_tour(targets, bare_cost(targets, geometry));
    ordered_ = targets;
    ordered_geometry_ = geometry;
  }
  const Placement placement = {X_WB * X_BP, X_WB * nominal_seat(*plan_.fixture)};
  CloudPath path(scene_, placement, geometry, plan_.machine->park_mm[2], targets, order_);
  if (!path.unreachable().empty()) {
    return core::fail(core::Code::kUnreachable, in_words(path.unreachable().front()));
  }
  return path;
}

std::vector<Target> FeaturePlanner::reachable(const std::vector<Target>& targets,
                                              const PathGeometry& geometry,
                                              const Eigen::Isometry3d& X_WB,
                                              const Eigen::Isometry3d& X_BP) const {
  std::vector<Target> out;
  for (const Target& target : targets) {
    if (check_clamp({target}, geometry, *plan_.fixture)) out.push_back(target);
  }
  if (out.empty()) return out;
  std::vector<std::size_t> own(out.size());
  std::iota(own.begin(), own.end(), std::size_t{0});
  const Placement placement = {X_WB * X_BP, X_WB * nominal_seat(*plan_.fixture)};
  const CloudPath path(scene_, placement, geometry, plan_.machine->park_mm[2], out, own);
  for (const Unreachable& missed : path.unreachable()) std::erase(out, missed.target);
  return out;
}

std::string in_words(const Unreachable& unreachable) {
  const Target& t = unreachable.target;
  return fmt::format("layer {}, point {} ({:.1f} deg): {}", t.layer + 1, t.point + 1,
                     t.theta_rad / core::kDegree, in_words(unreachable.hit));
}

}  // namespace rondure::plans
