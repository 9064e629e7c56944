#include "evaluation/invariants.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "fit/geometry/frames.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"

namespace rondure::evaluation {
namespace {

/// Collects relations of one feature; keeps the first that does not hold.
class Relations {
 public:
  /// @param kind   "CY" or "CI".
  /// @param place  ", layer 2", or empty.
  Relations(std::string kind, std::string place)
      : kind_(std::move(kind)), place_(std::move(place)) {}

  /// Less or equal, up to round-off. Values that are not numbers break every relation.
  void no_more(const std::string& left, double left_mm, const std::string& right, double right_mm) {
    if (broken_ || left_mm <= right_mm + kInvariantSlack) return;
    broken_ = BrokenInvariant{fmt::format("{} <= {}{}", left, right, place_),
                              fmt::format("{:.17g} mm > {:.17g} mm", left_mm, right_mm)};
  }
  void holds(const std::string& reference, const fit::ZoneCheck& checked) {
    if (broken_ || checked.fault.empty()) return;
    broken_ = BrokenInvariant{fmt::format("certificate of {}{}{}", reference, kind_, place_),
                              checked.fault};
  }
  [[nodiscard]] std::string named(const char* reference) const { return reference + kind_; }
  [[nodiscard]] std::optional<BrokenInvariant> first() const { return broken_; }

 private:
  std::string kind_;
  std::string place_;
  std::optional<BrokenInvariant> broken_;
};

/// A zone no wider than round-off needs no contacts: nothing can be narrower by more. The contacts
/// of a perfect part may lie on one side only.
template <class Zone>
fit::StatedZone stated(const Zone& zone) {
  if (zone.width_mm() <= kInvariantSlack)
    return {zone.inner_radius_mm, zone.outer_radius_mm, {}, {}};
  return {zone.inner_radius_mm, zone.outer_radius_mm, zone.outer, zone.inner};
}

template <class OneSided>
fit::StatedZone circumscribed(const OneSided& fit) {
  return {fit.radius_mm - fit.deviation_mm, fit.radius_mm, fit.contacts, {}};
}
template <class OneSided>
fit::StatedZone inscribed(const OneSided& fit) {
  return {fit.radius_mm, fit.radius_mm + fit.deviation_mm, {}, fit.contacts};
}

const fit::Axis& place_of(const fit::MinZoneCylinder& fit) { return fit.axis; }
const fit::Axis& place_of(const fit::OneSidedCylinder& fit) { return fit.axis; }
const Eigen::Vector2d& place_of(const fit::MinZoneCircle& fit) { return fit.center_mm; }
const Eigen::Vector2d& place_of(const fit::OneSidedCircle& fit) { return fit.center_mm; }

/// Checks the witness of one reference. Without a certificate there is nothing to check.
template <class Points, class Fit>
void check_witness(const Points& points, const char* name, const Fit& fit,
                   const fit::StatedZone& zone, Relations& relations) {
  if (fit.certificate.kind == fit::Certificate::Kind::kNone) return;
  relations.holds(name, fit::check_zone(points, place_of(fit), zone, kInvariantSlack));
}

/// MC and MI could have stopped at the place of MZ if their search passed through it. They must be
/// as good there, within the tolerance of the search; an optimum near the least-squares place only
/// may be worse, and gives a warning.
template <class Zone, class OneSided>
bool searched(const Zone& mz, const OneSided& mc) {
  return mc.certificate.kind == fit::Certificate::Kind::kGlobal &&
         (mc.certificate.scope == "all centres" || mc.certificate.scope == mz.certificate.scope);
}
bool searched(const std::vector<Eigen::Vector2d>& points, const fit::MinZoneCircle& mz,
              const fit::LsCircle& /*ls*/, const fit::OneSidedCircle& mi) {
  return mi.certificate.kind == fit::Certificate::Kind::kGlobal &&
         fit::meets_hull(fit::convex_hull(points), mz.center_mm, 0.0);
}
bool searched(const std::vector<Eigen::Vector3d>& points, const fit::MinZoneCylinder& mz,
              const fit::LsCylinder& ls, const fit::OneSidedCylinder& mi) {
  const double sine = std::min(1.0, mz.axis.direction.cross(ls.axis.direction).norm());
  const double ends = fit::half_extent(points, ls.axis.direction) * std::tan(std::asin(sine));
  return mi.certificate.kind == fit::Certificate::Kind::kGlobal &&
         fit::distance_mm(ls.axis, mz.axis.point_mm) + ends <= 0.25 * ls.radius_mm &&
         sine <= std::sin(9.0 * core::kDegree);
}

/// Checks the four references of the same points. A missing reference has no relations.
template <class Points, class Zone, class Ls, class OneSided>
void relate(const Points& points, const Zone& mz, const Ls& ls, const core::Result<OneSided>& mc,
            const core::Result<OneSided>& mi, Relations& relations) {
  const auto named = [&](const char* reference) { return relations.named(reference); };
  check_witness(points, "MZ", mz, stated(mz), relations);
  relations.no_more(named("MZ"), mz.width_mm(), named("LS"), ls.deviation_mm);
  if (mc) {
    check_witness(points, "MC", *mc, circumscribed(*mc), relations);
    relations.no_more(named("MZ"), mz.width_mm(), named("MC"), mc->deviation_mm);
    if (searched(mz, *mc)) {
      relations.no_more("radius of " + named("MC"), mc->radius_mm - mc->certificate.gap_mm,
                        "outer radius of " + named("MZ"), mz.outer_radius_mm);
    }
  }
  if (mi) {
    check_witness(points, "MI", *mi, inscribed(*mi), relations);
    relations.no_more(named("MZ"), mz.width_mm(), named("MI"), mi->deviation_mm);
    if (searched(points, mz, ls, *mi)) {
      relations.no_more("inner radius of " + named("MZ"), mz.inner_radius_mm,
                        "radius of " + named("MI"), mi->radius_mm + mi->certificate.gap_mm);
    }
  }
}

std::optional<BrokenInvariant> broken_in_section(const LayerResult& layer,
                                                 const FeatureResult& result) {
  if (!layer.mz || !layer.ls) return std::nullopt;
  Relations relations("CI", fmt::format(", layer {}", layer.layer + 1));
  relate(layer.points_mm, *layer.mz, *layer.ls, layer.mc, layer.mi, relations);
  if (result.mz_cylinder)
    relations.no_more("RONt", layer.mz->width_mm(), "CYLt", result.mz_cylinder->width_mm());
  return relations.first();
}

}  // namespace

std::optional<BrokenInvariant> broken_invariant(const FeatureResult& result) {
  if (result.failure) return std::nullopt;
  if (result.mz_cylinder && result.ls_cylinder) {
    std::vector<Eigen::Vector3d> points;
    points.reserve(result.cloud.size());
    // A point in a window counts as another one, so that rows keep their numbers.
    const auto kept = std::ranges::find(result.cloud, false, &CloudPoint::left_out);
    for (const CloudPoint& point : result.cloud) {
      points.push_back(point.left_out ? kept->tip_mm : point.tip_mm);
    }
    Relations relations("CY", "");
    relate(points, *result.mz_cylinder, *result.ls_cylinder, result.mc_cylinder, result.mi_cylinder,
           relations);
    if (auto broken = relations.first()) return broken;
  }
  for (const LayerResult& layer : result.layers) {
    if (auto broken = broken_in_section(layer, result)) return broken;
  }
  return std::nullopt;
}

}  // namespace rondure::evaluation
