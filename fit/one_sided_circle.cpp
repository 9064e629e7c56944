#include "fit/one_sided_circle.h"

#include "fit/points.h"
#include "fit/zone_fit.h"
#include "fit/zone_proof.h"

namespace rondure::fit {
namespace {

core::Result<OneSidedCircle> fit_one_sided(std::span<const Eigen::Vector2d> points_mm,
                                           const ZoneWeights& weights) {
  CircleZoneFitter fitter;
  const auto zone = fitter.fit(points_mm, weights);
  if (!zone) return core::fail(zone.error());
  const bool outside = weights.outer > 0.0;
  const double round_off =
      distance_round_off(zone->place.cwiseAbs().maxCoeff() + zone->outer_radius_mm);
  const CenterFrame<2> frame(Eigen::Vector2d::Zero());
  const auto proven = prove_zone(points_mm, zone->place, frame, weights, round_off);
  OneSidedCircle out;
  out.center_mm = zone->place;
  out.radius_mm = outside ? proven.zone.high : proven.zone.low;
  out.deviation_mm = proven.zone.width();
  const Contacts& contacts = outside ? proven.proof.outer : proven.proof.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = certify_local<2>(proven.proof, proven.zone.width(), round_off,
                                     "next to the least-squares centre");
  if (outside && out.certificate.kind == Certificate::Kind::kLocal) {
    // Convex: a local minimum is the global one.
    out.certificate = {Certificate::Kind::kGlobal, "all centres", out.certificate.gap_mm, ""};
  }
  return out;
}

}  // namespace

core::Result<OneSidedCircle> min_circumscribed_circle(std::span<const Eigen::Vector2d> points_mm) {
  return fit_one_sided(points_mm, kMinimumCircumscribed);
}

core::Result<OneSidedCircle> max_inscribed_circle(std::span<const Eigen::Vector2d> points_mm) {
  return fit_one_sided(points_mm, kMaximumInscribed);
}

}  // namespace rondure::fit
