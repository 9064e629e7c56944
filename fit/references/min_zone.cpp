#include "fit/references/min_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "fit/geometry/axis.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/internal/bisectors.h"
#include "fit/geometry/internal/cone_frame.h"
#include "fit/geometry/zone_rows.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/plane.h"
#include "fit/references/internal/proof.h"
#include "fit/zone/fit.h"
#include "fit/zone/internal/coupled_zone.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kEnumerated = 40;  // points up to which all bisector crossings can be tried

/// States the zone about a centre: radii, contacts, multipliers and the local certificate.
/// @return The first-order growth of the zone there.
double certify(PlanePoints points, const Eigen::Vector2d& center, MinZoneCircle& out) {
  double size = 0.0;
  for (const Eigen::Vector2d& p : points) size = std::max(size, p.cwiseAbs().maxCoeff());
  const double round_off = distance_round_off(size);
  const double growth = state_zone<2>(points, center, round_off, out);
  // All points are on one circle to round-off. This is global, as no zone is narrower than 0.
  if (out.width_mm() <= 16.0 * round_off) {
    out.certificate = {Certificate::Kind::kGlobal, core::phrase("all centres"), out.width_mm(), {}};
  }
  return growth;
}

/// Branch and bound over all centres; every better centre that it finds becomes the new start.
void search_all_centers(PlanePoints points, const GlobalSearchOptions& options,
                        CircleZoneFitter& fitter, double growth, MinZoneCircle& out) {
  for (int restart = 0; restart < kRestartLimit; ++restart) {
    if (out.certificate.kind != Certificate::Kind::kLocal) return;
    const auto search = search_centers(points, out.center_mm,
                                       {out.width_mm(), growth, out.outer, out.inner}, options);
    if (search.better) {
      growth = certify(points, fitter.fit_from(points, *search.better).place, out);
      continue;
    }
    const double gap = std::max(out.certificate.gap_mm, out.width_mm() - search.lower_mm);
    if (search.proven)
      out.certificate = {Certificate::Kind::kGlobal, core::phrase("all centres"), gap, {}};
    out.certificate.reason = search.reason;
    return;
  }
}

/// Tries every candidate of a small set whose zone is too wide for useful bounds.
void try_all_centers(PlanePoints points, CircleZoneFitter& fitter, MinZoneCircle& out) {
  const BisectorSearch all = search_bisectors(points, out.center_mm);
  if (all.width_mm < out.width_mm()) {
    MinZoneCircle other;
    certify(points, fitter.fit_from(points, all.center_mm).place, other);
    if (other.width_mm() < out.width_mm()) out = other;
  }
  if (out.certificate.kind == Certificate::Kind::kNone) return;
  if (all.complete) {
    const double gap = std::max(out.certificate.gap_mm, out.width_mm() - all.width_mm);
    out.certificate = {Certificate::Kind::kGlobal, core::phrase("all centres"), gap, {}};
  } else {
    out.certificate.reason = core::Phrase(fmt::format(
        "a strip of {:.9g} mm holds the points: the narrowest zone may have its centre at infinity",
        all.strip_mm));
  }
}

/// The zone of three distinct points, which lie on one circle: its width is 0.
MinZoneCircle exact_fit(const LsCircle& circle) {
  MinZoneCircle out;
  out.center_mm = circle.center_mm;
  out.inner_radius_mm = out.outer_radius_mm = circle.radius_mm;
  out.exact_fit = true;
  out.certificate = {Certificate::Kind::kGlobal, core::phrase("all centres"), 0.0, {}};
  return out;
}

}  // namespace

core::Result<MinZoneCircle> min_zone_circle(PlanePoints points_mm,
                                            const CenterProofOptions& options) {
  CircleZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm));
  if (distinct_points(points_mm, 4) < 4) {
    TRY(const auto circle, algebraic_circle(points_mm));
    return exact_fit(circle);
  }
  MinZoneCircle out;
  const double growth = certify(points_mm, zone.place, out);
  if (!options.global) return out;
  search_all_centers(points_mm, options.search, fitter, growth, out);
  const bool proven = out.certificate.kind == Certificate::Kind::kGlobal;
  if (!proven && points_mm.size() <= kEnumerated) try_all_centers(points_mm, fitter, out);
  return out;
}

core::Result<MinZoneSphere> min_zone_sphere(SpacePoints points_mm) {
  SphereZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm));
  const double round_off =
      distance_round_off(zone.place.cwiseAbs().maxCoeff() + zone.outer_radius_mm);
  MinZoneSphere out;
  state_zone<3>(points_mm, zone.place, round_off, out);
  return out;
}

core::Result<MinZoneCylinder> min_zone_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  CylinderZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm, near_direction));
  AxisProof proof = prove_axis(points_mm, zone, kMinimumZone);
  if (proof.certificate.kind == Certificate::Kind::kNone) {
    // Points that tie may hold a saddle that no single direction leaves: some of a bow, touched at
    // equal angles in every section, differ by less than rounding. Axes beside it lead out of it.
    const double tilts[] = {
        std::atan2(zone.outer_radius_mm - zone.inner_radius_mm, proof.half_length)};
    AxisProof other =
        prove_axis(points_mm, fitter.fit_around(points_mm, proof.axis, tilts, zone), kMinimumZone);
    if (other.proven.zone.width() < proof.proven.zone.width()) proof = std::move(other);
  }
  search_scopes(points_mm, options, kMinimumZone, {}, fitter, proof);
  MinZoneCylinder out;
  out.axis = conventional(proof.axis, mean_point(points_mm));
  out.inner_radius_mm = proof.proven.zone.low;
  out.outer_radius_mm = proof.proven.zone.high;
  out.boxes = proof.boxes;
  out.ending = proof.ending;
  out.certificate = proof.certificate;
  const LocalProof<4>& local = proof.proven.proof;
  out.outer.assign(local.outer.begin(), local.outer.end());
  out.inner.assign(local.inner.begin(), local.inner.end());
  return out;
}

namespace {

/// A cone from which the distances of all points are measured.
struct ConeZoneModel {
  static constexpr int kUnknowns = ConeFrame::kUnknowns;
  SpacePoints points;
  ConeFrame frame;

  [[nodiscard]] double value(std::size_t i) const { return frame.distance(points[i]); }
  [[nodiscard]] std::pair<double, ConeFrame::Step> slope(std::size_t i) const {
    return frame.slope(points[i]);
  }
  [[nodiscard]] MeasuredRow row(std::size_t i) const {
    const auto exact = frame.contact_row(points[i], i);
    return {exact.distance, exact.gradient, exact.hessian};
  }
  [[nodiscard]] ConeZoneModel moved(const Eigen::VectorXd& step) const {
    return {points, frame.moved(ConeFrame::Step(step))};
  }
  [[nodiscard]] bool strayed(const ConeZoneModel& from) const { return frame.strayed(from.frame); }
  [[nodiscard]] double scale_mm() const { return frame.length_mm(); }
};

/// A gap this small counts as none; results are required to 1e-9 mm.
constexpr double kNoConeGap = 1e-9;

/// Width minus the lower bound that the contacts give for all cones whose unknowns are within a
/// width of these.
double first_order_gap(const CoupledZone<ConeZoneModel>& zone, double width) {
  if (zone.contacts.empty()) return width;
  double gap = 0.0;
  ConeFrame::Step imbalance = ConeFrame::Step::Zero();
  for (const CoupledContact& c : zone.contacts) {
    const double share = c.bound == 0 ? c.multiplier : -c.multiplier;
    const auto [value, slope] = zone.model.slope(c.row);
    gap += share * (zone.bounds(static_cast<Eigen::Index>(c.bound)) - value);
    imbalance += share * slope;
  }
  return std::clamp(gap + imbalance.lpNorm<1>() * width, 0.0, width);
}

}  // namespace

core::Result<MinZoneCone> min_zone_cone(SpacePoints points_mm,
                                        const std::optional<Eigen::Vector3d>& near_direction) {
  TRY(const auto start, ls_cone(points_mm, near_direction));
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  double length = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back(p - mean);
    length = std::max(length, points.back().norm());
  }
  Axis axis = start.cone.axis;
  axis.point_mm -= mean;
  const std::vector<CoupledBound> sides = {{0, points.size(), true}, {0, points.size(), false}};
  const ConeZoneModel from{points, ConeFrame(axis, 0.5 * start.cone.full_angle_rad, length)};
  const auto zone = CoupledDescent<ConeZoneModel>(from, sides).run();
  MinZoneCone out;
  out.ending = zone.ending;
  out.width_mm = zone.bounds(0) - zone.bounds(1);
  const ConeFrame& found = zone.model.frame;
  out.cone.axis = conventional(found.axis(), Eigen::Vector3d::Zero());
  const double turned = out.cone.axis.direction.dot(found.axis().direction);
  out.cone.full_angle_rad = (turned < 0.0 ? -2.0 : 2.0) * found.half_angle_rad();
  const double shift = (out.cone.axis.point_mm - found.axis().point_mm).dot(found.axis().direction);
  out.cone.offset_mm =
      0.5 * (zone.bounds(0) + zone.bounds(1)) + shift * std::sin(found.half_angle_rad());
  out.cone.axis.point_mm += mean;
  for (const CoupledContact& c : zone.contacts) {
    (c.bound == 0 ? out.outer : out.inner).push_back({c.row, c.multiplier});
  }
  std::ranges::sort(out.outer, {}, &Contact::index);
  std::ranges::sort(out.inner, {}, &Contact::index);
  out.certificate.scope = core::phrase("next to the least-squares cone");
  out.certificate.gap_mm = first_order_gap(zone, out.width_mm);
  if (zone.ending == ZoneEnding::kConverged) {
    out.certificate.kind = Certificate::Kind::kLocal;
    out.certificate.reason = core::phrase("other regions were not searched");
    return out;
  }
  // Where one generatrix holds the zone, cones that turn about it are as good to first order, and
  // no single one of them is a minimum to second order.
  if (out.certificate.gap_mm <= kNoConeGap) out.ending = ZoneEnding::kConverged;
  out.certificate.reason = core::phrase("the contacts hold the zone to first order only");
  return out;
}

namespace {

constexpr int kProgrammes = 20;
/// A slope below this moves a point of a plane of 1 m by less than its rounding.
constexpr double kAtRest = 1e-15;
/// A bound this close counts as the value; results are required to 1e-9 mm.
constexpr double kProven = 1e-9;

/// The points relative to their mean, within the plane and across it.
struct FlatPoints {
  std::vector<Eigen::Vector2d> within;
  std::vector<double> heights;
  double reach = 0.0;  ///< Greatest distance from the mean within the plane.
};

FlatPoints flat_points(SpacePoints points, const Plane& plane) {
  const auto frame = across(plane.normal);
  FlatPoints out;
  for (const Eigen::Vector3d& p : points) {
    out.within.emplace_back(frame.transpose() * (p - plane.point_mm));
    out.heights.push_back(height_mm(plane, p));
    out.reach = std::max(out.reach, out.within.back().norm());
  }
  return out;
}

/// Least range of the heights over all slopes; the step is a slope times `reach`.
ZoneStep<2> least_range(const FlatPoints& points) {
  ZoneRows<2> rows;
  for (std::size_t i = 0; i < points.within.size(); ++i) {
    rows.push_back(points.heights[i], -points.within[i] / points.reach);
  }
  return solve_zone_program<2>(rows, points.reach);
}

/// How fast the range grows with the slope, at least: the distance of the origin from the sides of
/// the hull of the differences of lower and upper contacts; 0 if it is not inside.
double growth(const FlatPoints& points, const ZoneStep<2>& step) {
  std::vector<Eigen::Vector2d> differences;
  for (const Contact& low : step.inner) {
    for (const Contact& high : step.outer) {
      differences.push_back(points.within[low.index] - points.within[high.index]);
    }
  }
  const auto hull = convex_hull(differences);
  if (hull.size() < 3) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d side = hull[(i + 1) % hull.size()] - hull[i];
    least = std::min(least, (side.x() * -hull[i].y() + side.y() * hull[i].x()) / side.norm());
  }
  return std::max(0.0, least);
}

Certificate plane_certificate(const FlatPoints& points, const ZoneStep<2>& step, double width,
                              double extent) {
  // Every pair of multipliers that sum to 1 gives a lower bound of the range at any slope, apart
  // from the imbalance of their points.
  double bound = 0.0;
  for (const Contact& c : step.outer) bound += c.multiplier * points.heights[c.index];
  for (const Contact& c : step.inner) bound -= c.multiplier * points.heights[c.index];
  bound = std::min(bound, width);
  const double farthest = 2.0 * width / (extent - width);
  const bool sharp = growth(points, step) >= 0.5 * width * farthest;
  const double gap = width - (sharp ? bound : bound / std::hypot(1.0, farthest));
  Certificate out{Certificate::Kind::kGlobal, core::phrase("all directions"), gap, {}};
  if (gap > kProven) {
    out.kind = Certificate::Kind::kLocal;
    out.reason = core::phrase("the contacts hold the zone to first order only");
  }
  return out;
}

}  // namespace

core::Result<MinZonePlane> min_zone_plane(SpacePoints points_mm,
                                          const std::optional<Eigen::Vector3d>& outward) {
  TRY(const auto start, ls_plane(points_mm, outward));
  MinZonePlane out;
  Plane plane = start.plane;
  FlatPoints points = flat_points(points_mm, plane);
  ZoneStep<2> step = least_range(points);
  for (int i = 0; i < kProgrammes && step.solved && step.inside_box; ++i) {
    const Eigen::Vector2d slope = step.step / points.reach;
    if (slope.norm() <= kAtRest) {
      out.ending = ZoneEnding::kConverged;
      break;
    }
    plane.normal = (plane.normal - across(plane.normal) * slope).normalized();
    points = flat_points(points_mm, plane);
    step = least_range(points);
  }
  const Extremes heights = extremes_of(points.heights, [](double h) { return h; });
  const double extent = least_width(points.within);
  out.width_mm = heights.width();
  if (!(extent > out.width_mm)) {
    return core::fail_with(core::Code::kRank,
                           "the points extend {:.6g} mm within the plane and {:.6g} mm across it: "
                           "no plane is distinguished; measure a larger face",
                           extent, out.width_mm);
  }
  out.outer = {plane.point_mm + heights.high * plane.normal, plane.normal};
  out.top.assign(step.outer.begin(), step.outer.end());
  out.bottom.assign(step.inner.begin(), step.inner.end());
  if (out.ending == ZoneEnding::kConverged) {
    out.certificate = plane_certificate(points, step, out.width_mm, extent);
  }
  return out;
}

}  // namespace rondure::fit
