#include "fit/min_zone_cylinder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "fit/axis_cover.h"
#include "fit/points.h"
#include "fit/zone_fit.h"
#include "fit/zone_proof.h"

namespace rondure::fit {
namespace {

/// A zone as it is stated, with its certificate.
struct Solved {
  Axis axis;  ///< Its point midway between the ends of the points.
  double half_length = 0.0;
  ProvenZone<CylinderFrame> proven;
  Certificate certificate;
};

Solved solved(SpacePoints points, const Axis& found) {
  Solved out;
  out.axis = found;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double size = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const double height = (p - found.point_mm).dot(found.direction);
    low = std::min(low, height);
    high = std::max(high, height);
    size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  const double round_off = distance_round_off(size);
  out.axis.point_mm += 0.5 * (low + high) * found.direction;
  out.half_length = std::max(0.5 * (high - low), round_off);
  const CylinderFrame frame({Eigen::Vector3d::Zero(), found.direction}, out.half_length);
  out.proven = prove_zone(points, out.axis.point_mm, frame, kMinimumZone, round_off);
  const double width = out.proven.zone.width();
  out.certificate =
      certify_local<4>(out.proven.proof, width, round_off, "next to the least-squares axis");
  // All points on one cylinder to round-off: nothing is left to prove, no zone is narrower than 0.
  if (width <= 16.0 * round_off) {
    out.certificate = {Certificate::Kind::kGlobal, "all directions", width, ""};
  }
  return out;
}

/// "all directions", "within 10 deg of nominal".
std::string scope_text(const AxisScope& scope) {
  if (scope.kind == AxisScope::Kind::kHalfSphere) return "all directions";
  return fmt::format("within {:.6g} deg of nominal", scope.cone_rad / core::kDegree);
}

/// Why the claimed axis cannot be compared with those of a scope; empty when it can.
std::string outside(const Solved& solution, const AxisScope& scope) {
  if (scope.kind == AxisScope::Kind::kHalfSphere) return {};
  const double sine = solution.axis.direction.cross(scope.nominal.normalized()).norm();
  const double angle = std::asin(std::min(1.0, sine));
  if (angle <= scope.cone_rad) return {};
  return fmt::format("the axis is {:.4g} deg from nominal, the searched cone ends at {:.4g} deg",
                     angle / core::kDegree, scope.cone_rad / core::kDegree);
}

/// Searches one scope; every better axis it meets becomes the new start.
/// @return Whether the certificate is now global.
bool search_scope(SpacePoints points, const AxisScope& scope, const GlobalSearchOptions& options,
                  CylinderZoneFitter& fitter, Solved& solution, int& boxes) {
  const bool whole = scope.kind == AxisScope::Kind::kHalfSphere;
  const auto directions = whole ? cover_half_sphere() : cover_cone(scope.nominal, scope.cone_rad);
  for (int restart = 0; restart < kRestartLimit; ++restart) {
    if (solution.certificate.kind == Certificate::Kind::kNone) return false;
    if (auto reason = outside(solution, scope); !reason.empty()) {
      solution.certificate.reason = reason;
      return false;
    }
    const LocalProof<4>& proof = solution.proven.proof;
    const double width = solution.proven.zone.width();
    const auto search =
        search_axes(points, solution.axis, solution.half_length,
                    {width, proof.growth, proof.outer, proof.inner}, directions, options);
    boxes += search.boxes;
    if (!search.better) {
      solution.certificate.reason = search.reason;
      if (!search.proven) return false;
      const double gap = std::max(solution.certificate.gap_mm, width - search.lower_mm);
      solution.certificate = {Certificate::Kind::kGlobal, scope_text(scope), gap, ""};
      return true;
    }
    solution = solved(points, fitter.fit_from(points, *search.better).place);
  }
  return false;
}

}  // namespace

core::Result<MinZoneCylinder> min_zone_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const MinZoneCylinderOptions& options) {
  CylinderZoneFitter fitter;
  const auto zone = fitter.fit(points_mm, near_direction);
  if (!zone) return core::fail(zone.error());
  Solved solution = solved(points_mm, zone->place);
  MinZoneCylinder out;
  for (const AxisScope& scope : options.scopes) {
    if (solution.certificate.kind == Certificate::Kind::kGlobal) break;
    if (search_scope(points_mm, scope, options.search, fitter, solution, out.boxes)) break;
  }
  out.axis = conventional(solution.axis, mean_point(points_mm));
  out.inner_radius_mm = solution.proven.zone.low;
  out.outer_radius_mm = solution.proven.zone.high;
  out.programmes = zone->programmes;
  out.certificate = solution.certificate;
  const LocalProof<4>& proof = solution.proven.proof;
  out.outer.assign(proof.outer.begin(), proof.outer.end());
  out.inner.assign(proof.inner.begin(), proof.inner.end());
  return out;
}

}  // namespace rondure::fit
