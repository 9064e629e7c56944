#include "fit/references/one_sided_center.h"

#include <algorithm>

#include <fmt/format.h>

#include "fit/references/internal/zone_proof.h"
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

}  // namespace rondure::fit
