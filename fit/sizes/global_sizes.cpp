#include "fit/sizes/global_sizes.h"

#include <cmath>
#include <span>

#include "fit/least_squares/sphere.h"
#include "fit/zone/fit.h"

namespace rondure::fit {
namespace {

/// A radius of a zone, if its search converged.
template <class Place>
core::Result<double> settled(const core::Result<ZoneFit<Place>>& zone, double radius_mm) {
  if (!zone) return core::fail(zone.error());
  if (zone->ending != ZoneEnding::kConverged) {
    return core::fail(core::Code::kNotConverged,
                      "the search for a global size did not reach its optimum");
  }
  return radius_mm;
}

/// @param fit  Fits the zone with the given weights.
template <class Fit>
core::Result<GlobalSizes> sizes_of(double ls_radius_mm, const Material& material, const Fit& fit) {
  TRY_DO(check_material(material, ls_radius_mm));
  const auto least = fit(kMinimumCircumscribed);
  TRY(const auto outer, settled(least, least ? least->outer_radius_mm : 0.0));
  const auto zone = fit(kMinimumZone);
  TRY(const auto middle,
      settled(zone, zone ? 0.5 * (zone->outer_radius_mm + zone->inner_radius_mm) : 0.0));
  GlobalSizes out;
  out.gg_mm = material.diameter_mm(ls_radius_mm);
  out.gn_mm = material.diameter_mm(outer);
  out.gc_mm = material.diameter_mm(middle);
  const auto largest = fit(kMaximumInscribed);
  out.gx_mm = settled(largest, largest ? largest->inner_radius_mm : 0.0).map([&](double radius) {
    return material.diameter_mm(radius);
  });
  return out;
}

template <int D>
core::Result<GlobalSizes> sizes_about_center(std::span<const Eigen::Matrix<double, D, 1>> points_mm,
                                             const Material& material,
                                             const core::Result<LsCenter<D>>& ls) {
  TRY_DO(check_material(material));
  if (!ls) return core::fail(ls.error());
  CenterZoneFitter<D> fitter;
  return sizes_of(ls->radius_mm, material,
                  [&](const ZoneWeights& weights) { return fitter.fit(points_mm, weights); });
}

}  // namespace

core::Result<void> check_material(const Material& material) {
  if (std::isfinite(material.tip_radius_mm) && material.tip_radius_mm >= 0.0) return {};
  return core::fail_with(core::Code::kBadOption,
                         "the tip radius is {} mm; a finite number not below 0 is needed",
                         material.tip_radius_mm);
}

core::Result<void> check_material(const Material& material, double center_radius_mm) {
  if (auto checked = check_material(material); !checked) return checked;
  const double radius_mm = material.surface_radius_mm(center_radius_mm);
  if (!(radius_mm <= 0.0)) return {};
  return core::fail_with(core::Code::kBadOption,
                         "the tip centres lie on a radius of {:.4f} mm, and a tip radius of {:.4f} "
                         "mm leaves a surface radius of {:.4f} mm, which must be above 0: correct "
                         "the tip diameter or the side of the feature",
                         center_radius_mm, material.tip_radius_mm, radius_mm);
}

core::Result<GlobalSizes> global_sizes(SpacePoints points_mm, const Material& material,
                                       const std::optional<Eigen::Vector3d>& near_direction) {
  TRY_DO(check_material(material));
  TRY(const auto ls, ls_cylinder(points_mm, near_direction));
  CylinderZoneFitter fitter;
  return sizes_of(ls.radius_mm, material, [&](const ZoneWeights& weights) {
    return fitter.fit(points_mm, ls.axis.direction, weights);
  });
}

core::Result<GlobalSizes> global_sizes(PlanePoints points_mm, const Material& material) {
  return sizes_about_center<2>(points_mm, material, ls_circle(points_mm));
}

core::Result<GlobalSizes> global_sizes_of_sphere(SpacePoints points_mm, const Material& material) {
  return sizes_about_center<3>(points_mm, material, ls_sphere(points_mm));
}

}  // namespace rondure::fit
