#include "fit/references/min_zone_circle.h"

#include <algorithm>

#include <fmt/format.h>

#include "fit/geometry/internal/bisectors.h"
#include "fit/least_squares/circle.h"
#include "fit/references/internal/zone_proof.h"
#include "fit/zone/fit.h"

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

}  // namespace rondure::fit
