#include "fit/one_sided_center.h"

#include "fit/zone_fit.h"
#include "fit/zone_proof.h"

namespace rondure::fit {
namespace {

template <int D>
core::Result<OneSidedCenter<D>> fit_one_sided(
    std::span<const Eigen::Matrix<double, D, 1>> points_mm, const ZoneWeights& weights) {
  CenterZoneFitter<D> fitter;
  const auto zone = fitter.fit(points_mm, weights);
  if (!zone) return core::fail(zone.error());
  const bool outside = weights.outer > 0.0;
  const double round_off =
      distance_round_off(zone->place.cwiseAbs().maxCoeff() + zone->outer_radius_mm);
  const CenterFrame<D> frame(Eigen::Matrix<double, D, 1>::Zero());
  const auto proven = prove_zone(points_mm, zone->place, frame, weights, round_off);
  OneSidedCenter<D> out;
  out.center_mm = zone->place;
  out.radius_mm = outside ? proven.zone.high : proven.zone.low;
  out.deviation_mm = proven.zone.width();
  const Contacts& contacts = outside ? proven.proof.outer : proven.proof.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = certify_local<D>(proven.proof, proven.zone.width(), round_off,
                                     "next to the least-squares centre");
  if (outside && out.certificate.kind == Certificate::Kind::kLocal) {
    // Convex: a local minimum is the global one.
    out.certificate = {Certificate::Kind::kGlobal, "all centres", out.certificate.gap_mm, ""};
  }
  return out;
}

}  // namespace

core::Result<OneSidedCircle> min_circumscribed_circle(std::span<const Eigen::Vector2d> points_mm) {
  return fit_one_sided<2>(points_mm, kMinimumCircumscribed);
}
core::Result<OneSidedSphere> min_circumscribed_sphere(std::span<const Eigen::Vector3d> points_mm) {
  return fit_one_sided<3>(points_mm, kMinimumCircumscribed);
}
core::Result<OneSidedCircle> max_inscribed_circle(std::span<const Eigen::Vector2d> points_mm) {
  return fit_one_sided<2>(points_mm, kMaximumInscribed);
}
core::Result<OneSidedSphere> max_inscribed_sphere(std::span<const Eigen::Vector3d> points_mm) {
  return fit_one_sided<3>(points_mm, kMaximumInscribed);
}

}  // namespace rondure::fit
