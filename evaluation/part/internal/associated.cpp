#include "evaluation/part/internal/associated.h"

#include <cmath>

#include "core/units.h"
#include "evaluation/part/internal/layout.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sphere.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "fit/zone/fit.h"

namespace rondure::evaluation {
namespace {

using record::Reference;

constexpr std::size_t kFewestOfCylinder = 6;

template <class Contacts>
void add_contacts(const Contacts& contacts, Associated& out) {
  for (const fit::Contact& contact : contacts) out.contacts.push_back(contact.index);
}

bool has_certificate(const fit::Certificate& certificate) {
  return certificate.kind != fit::Certificate::Kind::kNone;
}

template <class Zone>
Associated of_zone(const Zone& zone) {
  Associated out;
  out.radius_mm = 0.5 * (zone.outer_radius_mm + zone.inner_radius_mm);
  out.deviation_mm = zone.width_mm();
  out.certified = has_certificate(zone.certificate);
  add_contacts(zone.outer, out);
  add_contacts(zone.inner, out);
  return out;
}

template <class Fit>
Associated of_one_sided(const Fit& fit) {
  Associated out;
  out.radius_mm = fit.radius_mm;
  out.deviation_mm = fit.deviation_mm;
  out.certified = has_certificate(fit.certificate);
  add_contacts(fit.contacts, out);
  return out;
}

core::Result<Associated> proven_cylinder(fit::SpacePoints points_mm, Reference reference,
                                         const Eigen::Vector3d& direction,
                                         const fit::CylinderProofOptions& options) {
  if (reference == Reference::kMinimumZone) {
    TRY(const auto zone, fit::min_zone_cylinder(points_mm, direction, options));
    Associated out = of_zone(zone);
    out.axis = zone.axis;
    return out;
  }
  TRY(const auto fit, reference == Reference::kMinimumCircumscribed
                          ? fit::min_circumscribed_cylinder(points_mm, direction, options)
                          : fit::max_inscribed_cylinder(points_mm, direction, options));
  Associated out = of_one_sided(fit);
  out.axis = fit.axis;
  return out;
}

/// The optimum next to the axis of the proven one of the cloud as measured, of which a trial moves
/// the points a little. Without one a search about `direction` looks for it.
core::Result<Associated> next_cylinder(const PreparedSurface& surface, Reference reference,
                                       const Eigen::Vector3d& direction, double radius_mm) {
  const fit::ZoneWeights& weights = reference == Reference::kMinimumZone ? fit::kMinimumZone
                                    : reference == Reference::kMinimumCircumscribed
                                        ? fit::kMinimumCircumscribed
                                        : fit::kMaximumInscribed;
  const auto& known =
      reference == Reference::kMaximumInscribed ? surface.of->mi_cylinder : surface.of->mc_cylinder;
  fit::CylinderZoneFitter fitter;
  TRY(const auto zone, reference != Reference::kMinimumZone && known
                           ? fitter.fit_from(surface.points_mm, known->axis, weights, radius_mm)
                           : fitter.fit(surface.points_mm, direction, weights));
  if (zone.ending != fit::ZoneEnding::kConverged) {
    return core::fail(core::Code::kNotConverged,
                      core::phrase("the search for the reference did not reach its optimum"));
  }
  Associated out;
  out.radius_mm = reference == Reference::kMinimumCircumscribed ? zone.outer_radius_mm
                  : reference == Reference::kMaximumInscribed
                      ? zone.inner_radius_mm
                      : 0.5 * (zone.outer_radius_mm + zone.inner_radius_mm);
  out.deviation_mm = zone.width_mm();
  out.axis = zone.place;
  out.pivots = zone.pivots;
  add_contacts(zone.outer, out);
  add_contacts(zone.inner, out);
  return out;
}

/// Whether a cylinder can rest on the points, and something is left of them to judge.
core::Result<void> check_cylinder(const PreparedSurface& surface) {
  if (surface.points_mm.size() < kFewestOfCylinder) {
    return core::fail(core::Code::kTooFewPoints,
                      core::phrase("{} points determine a cylinder and leave nothing to judge; "
                                   "plan at least {}",
                                   surface.points_mm.size(), kFewestOfCylinder));
  }
  if (surface.sections.size() == 1) {
    return core::fail(core::Code::kRank,
                      core::phrase("1 section leaves the axis undetermined: plan at least 2 "
                                   "layers, or ask for the size of the section (section \"SCS\")"));
  }
  return {};
}

core::Result<void> check_turn(fit::SpacePoints points_mm, const fit::Axis& axis) {
  const auto frame = fit::across(axis.direction);
  unsigned octants = 0;  // with a point in each no gap is wider than two of them
  for (const Eigen::Vector3d& p : points_mm) {
    const Eigen::Vector2d v = frame.transpose() * (p - axis.point_mm);
    const bool steep = std::abs(v.y()) > std::abs(v.x());
    octants |= 1U << ((v.x() > 0.0 ? 4U : 0U) + (v.y() > 0.0 ? 2U : 0U) + (steep ? 1U : 0U));
  }
  if (octants == 0xFFU) return {};
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& p : points_mm) {
    flat.emplace_back(frame.transpose() * (p - axis.point_mm));
  }
  const double open_deg = core::degrees(fit::largest_gap_rad(flat, Eigen::Vector2d::Zero()));
  constexpr double kRoundOff = 1e-6;
  if (open_deg < 180.0 - kRoundOff) return {};
  return core::fail(core::Code::kReferenceAbsent,
                    core::phrase("the points leave {:.0f} deg of the turn open: no cylinder rests "
                                 "on them; measure all round",
                                 open_deg));
}

}  // namespace

core::Result<Associated> associated_cylinder(const PreparedSurface& surface, Reference reference,
                                             Proof proof) {
  TRY_DO(check_cylinder(surface));
  const fit::SpacePoints points_mm = surface.points_mm;
  TRY(const auto ls, fit::ls_cylinder(points_mm, surface.axis.direction));
  const Eigen::Vector3d& direction = ls.axis.direction;
  TRY_DO(check_turn(points_mm, ls.axis));
  if (reference == Reference::kLeastSquares) {
    Associated out;
    out.radius_mm = ls.radius_mm;
    out.deviation_mm = ls.deviation_mm;
    out.axis = ls.axis;
    return out;
  }
  if (proof == Proof::kNone) return next_cylinder(surface, reference, direction, ls.radius_mm);
  // As the evaluation of the feature: only layers say something of the direction of a points file.
  const fit::AxisScope cone{.kind = fit::AxisScope::Kind::kCone, .nominal = direction};
  fit::CylinderProofOptions options;
  if (surface.of->feature.strategy == record::Strategy::kPointsFile) {
    options.scopes.push_back({.kind = fit::AxisScope::Kind::kHalfSphere});
    if (has_layers(*surface.of)) options.candidates = cone;
  }
  options.scopes.push_back(cone);
  return proven_cylinder(points_mm, reference, direction, options);
}

core::Result<Associated> associated_circle(fit::PlanePoints points_mm, Reference reference,
                                           Proof proof) {
  const fit::CenterProofOptions options{.global = proof == Proof::kFull, .search = {}};
  if (reference == Reference::kLeastSquares) {
    TRY(const auto circle, fit::ls_circle(points_mm));
    Associated out;
    out.radius_mm = circle.radius_mm;
    out.deviation_mm = circle.deviation_mm;
    out.center_mm = circle.center_mm;
    return out;
  }
  if (reference == Reference::kMinimumZone) {
    TRY(const auto zone, fit::min_zone_circle(points_mm, options));
    Associated out = of_zone(zone);
    out.center_mm = zone.center_mm;
    out.exact_fit = zone.exact_fit;
    return out;
  }
  TRY(const auto circle, reference == Reference::kMinimumCircumscribed
                             ? fit::min_circumscribed_circle(points_mm)
                             : fit::max_inscribed_circle(points_mm, options));
  Associated out = of_one_sided(circle);
  out.center_mm = circle.center_mm;
  out.range = circle.range;
  return out;
}

core::Result<Associated> associated_sphere(fit::SpacePoints points_mm, Reference reference) {
  if (reference == Reference::kLeastSquares) {
    return fit::ls_sphere(points_mm).map([](const fit::LsSphere& sphere) {
      Associated out;
      out.radius_mm = sphere.radius_mm;
      out.deviation_mm = sphere.deviation_mm;
      return out;
    });
  }
  if (reference == Reference::kMinimumZone) {
    return fit::min_zone_sphere(points_mm).map(of_zone<fit::MinZoneSphere>);
  }
  return (reference == Reference::kMinimumCircumscribed ? fit::min_circumscribed_sphere(points_mm)
                                                        : fit::max_inscribed_sphere(points_mm))
      .map(of_one_sided<fit::OneSidedSphere>);
}

}  // namespace rondure::evaluation
