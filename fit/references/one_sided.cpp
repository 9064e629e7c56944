#include "fit/references/one_sided.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "fit/least_squares/line.h"
#include "fit/references/internal/proof.h"
#include "fit/references/min_zone.h"
#include "fit/zone/fit.h"

namespace rondure::fit {
namespace {

/// States the circle or sphere about a centre, with its local certificate.
/// @return The first-order growth there.
template <int D>
double state(std::span<const Eigen::Matrix<double, D, 1>> points_mm,
             const ZoneFit<Eigen::Matrix<double, D, 1>>& zone, const ZoneWeights& weights,
             OneSidedCenter<D>& out) {
  const bool outside = weights.outer > 0.0;
  const double round_off =
      distance_round_off(zone.place.cwiseAbs().maxCoeff() + zone.outer_radius_mm);
  const CenterFrame<D> frame(Eigen::Matrix<double, D, 1>::Zero());
  const auto proven = prove_zone(points_mm, zone.place, frame, weights, round_off);
  out.center_mm = zone.place;
  out.radius_mm = outside ? proven.zone.high : proven.zone.low;
  out.deviation_mm = proven.zone.width();
  const Contacts& contacts = outside ? proven.proof.outer : proven.proof.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = certify_local<D>(proven.proof, proven.zone.width(), round_off,
                                     core::Phrase("next to the least-squares centre"));
  return proven.proof.growth;
}

template <int D>
core::Result<OneSidedCenter<D>> fit_one_sided(
    std::span<const Eigen::Matrix<double, D, 1>> points_mm, const ZoneWeights& weights) {
  CenterZoneFitter<D> fitter;
  TRY(const auto zone, fitter.fit(points_mm, weights));
  OneSidedCenter<D> out;
  state<D>(points_mm, zone, weights, out);
  if (weights.outer > 0.0 && out.certificate.kind == Certificate::Kind::kLocal) {
    // The problem is convex, so a local minimum is the global one.
    out.certificate = {
        Certificate::Kind::kGlobal, core::phrase("all centres"), out.certificate.gap_mm, {}};
  }
  return out;
}

/// Branch and bound over the centres inside the hull; every better one becomes the new start.
void search_inscribed(PlanePoints points, const GlobalSearchOptions& options,
                      CircleZoneFitter& fitter, double growth, OneSidedCircle& out) {
  for (int restart = 0; restart < kRestartLimit; ++restart) {
    if (out.certificate.kind == Certificate::Kind::kNone) return;
    const auto search =
        search_centers(points, out.center_mm,
                       {-out.radius_mm, growth, {}, out.contacts, kMaximumInscribed, {}}, options);
    if (search.better) {
      const CircleZone next = fitter.fit_from(points, *search.better, kMaximumInscribed);
      // The circle may leave the hull through a gap between the points and is then not inscribed.
      if (!meets_hull(convex_hull(points), next.place, 0.0)) {
        out.certificate.reason = core::Phrase("a larger circle leaves the hull of the points");
        return;
      }
      if (!(next.inner_radius_mm > out.radius_mm)) {
        out.certificate.reason =
            core::Phrase("a larger circle was met, its optimum was not reached");
        return;
      }
      growth = state<2>(points, next, kMaximumInscribed, out);
      continue;
    }
    out.certificate.reason = search.reason;
    if (!search.proven) return;
    const double gap = std::max(out.certificate.gap_mm, -out.radius_mm - search.lower_mm);
    out.certificate = {Certificate::Kind::kGlobal,
                       core::Phrase("all centres inside the hull of the points"),
                       gap,
                       {}};
    return;
  }
  out.certificate.reason =
      core::Phrase(fmt::format("{} larger circles were met, one after the other", kRestartLimit));
}

}  // namespace

core::Result<OneSidedCircle> min_circumscribed_circle(PlanePoints points_mm) {
  return fit_one_sided<2>(points_mm, kMinimumCircumscribed);
}
core::Result<OneSidedSphere> min_circumscribed_sphere(SpacePoints points_mm) {
  return fit_one_sided<3>(points_mm, kMinimumCircumscribed);
}
core::Result<OneSidedCircle> max_inscribed_circle(PlanePoints points_mm,
                                                  const CenterProofOptions& options) {
  CircleZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm, kMaximumInscribed));
  OneSidedCircle out;
  const double growth = state<2>(points_mm, zone, kMaximumInscribed, out);
  if (!options.global) return out;
  search_inscribed(points_mm, options.search, fitter, growth, out);
  out.range = inscribed_deviation_range(points_mm, out.center_mm, out.radius_mm);
  return out;
}
core::Result<OneSidedSphere> max_inscribed_sphere(SpacePoints points_mm) {
  return fit_one_sided<3>(points_mm, kMaximumInscribed);
}

namespace {

OneSidedCylinder stated(SpacePoints points_mm, const AxisProof& proof, const ZoneWeights& weights) {
  const bool outside = weights.outer > 0.0;
  const Extremes& zone = proof.proven.zone;
  OneSidedCylinder out;
  out.axis = conventional(proof.axis, mean_point(points_mm));
  out.radius_mm = outside ? zone.high : zone.low;
  out.deviation_mm = zone.width();
  const LocalProof<4>& local = proof.proven.proof;
  const Contacts& contacts = outside ? local.outer : local.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = proof.certificate;
  if (!proof.other) return out;
  OneSidedCylinder::Other other;
  const Extremes radii =
      extremes_of(points_mm, [&](const auto& p) { return distance_mm(*proof.other, p); });
  other.radius_mm = outside ? radii.high : radii.low;
  other.lean_rad =
      std::asin(std::min(1.0, proof.axis.direction.cross(proof.other->direction).norm()));
  other.apart_mm = distance_mm(*proof.other, proof.axis.point_mm);
  out.other = other;
  return out;
}

core::Result<OneSidedCylinder> fit_one_sided(SpacePoints points_mm,
                                             const std::optional<Eigen::Vector3d>& near_direction,
                                             const ZoneWeights& weights,
                                             const CylinderProofOptions& options) {
  CylinderZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm, near_direction, weights));
  AxisProof proof = prove_axis(points_mm, zone, weights);
  // Circumscribed: two radii, the limit of the descent. Inscribed: less than that limit, so that
  // all axes of the scope stay inside the points.
  const LsCylinder& start = fitter.start();
  const AxisReach reach{start.axis, (weights.outer > 0.0 ? 2.0 : 0.5) * start.radius_mm};
  search_scopes(points_mm, options, weights, reach, fitter, proof);
  return stated(points_mm, proof, weights);
}

/// The smallest cylinder about three points: its axis is parallel to the longest side of their
/// triangle, and its diameter the least altitude, since no view of a triangle is narrower.
MinZoneLine about_triangle(SpacePoints points_mm) {
  std::size_t apex = 0;
  double longest = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = (points_mm[(i + 1) % 3] - points_mm[(i + 2) % 3]).norm();
    if (side > longest) {
      longest = side;
      apex = i;
    }
  }
  const std::size_t from = (apex + 1) % 3;
  const std::size_t to = (apex + 2) % 3;
  const Eigen::Vector3d along = (points_mm[to] - points_mm[from]) / longest;
  const Eigen::Vector3d v = points_mm[apex] - points_mm[from];
  const Eigen::Vector3d altitude = v - along.dot(v) * along;
  const double share = along.dot(v) / longest;
  MinZoneLine out;
  out.axis = conventional({points_mm[from] + 0.5 * altitude, along}, mean_point(points_mm));
  out.diameter_mm = altitude.norm();
  out.contacts = {{apex, 0.5}, {from, 0.5 * (1.0 - share)}, {to, 0.5 * share}};
  std::ranges::sort(out.contacts, {}, &Contact::index);
  out.certificate = {Certificate::Kind::kGlobal, core::phrase("all directions"), 0.0, {}};
  return out;
}

}  // namespace

core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  return fit_one_sided(points_mm, near_direction, kMinimumCircumscribed, options);
}

core::Result<OneSidedCylinder> max_inscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  return fit_one_sided(points_mm, near_direction, kMaximumInscribed, options);
}

core::Result<MinZoneLine> min_zone_line(SpacePoints points_mm, Proof proof) {
  TRY(const auto line, ls_line(points_mm));
  if (points_mm.size() == 3) return about_triangle(points_mm);
  CylinderZoneFitter fitter;
  const CylinderZone zone = fitter.fit_from(points_mm, line.axis, kMinimumCircumscribed);
  if (proof == Proof::kNone) return MinZoneLine{zone.place, 2.0 * zone.outer_radius_mm, {}, {}};
  OneSidedCylinder found =
      stated(points_mm, prove_axis(points_mm, zone, kMinimumCircumscribed), kMinimumCircumscribed);
  MinZoneLine out;
  out.axis = found.axis;
  out.diameter_mm = 2.0 * found.radius_mm;
  out.contacts = std::move(found.contacts);
  out.certificate = std::move(found.certificate);
  out.certificate.scope = core::phrase("next to the least-squares line");
  return out;
}

}  // namespace rondure::fit
