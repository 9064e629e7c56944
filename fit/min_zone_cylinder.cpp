#include "fit/min_zone_cylinder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "fit/axis_cover.h"
#include "fit/cylinder_descent.h"
#include "fit/cylinder_frame.h"
#include "fit/ls_cylinder.h"
#include "fit/points.h"

namespace rondure::fit {
namespace {

constexpr int kRestartLimit = 20;

using Points = std::span<const Eigen::Vector3d>;

/// Size of rounding errors of a distance: relative coordinates carry the error of the given ones.
double round_off_of(Points points_mm) {
  double size = 0.0;
  for (const Eigen::Vector3d& p : points_mm) size = std::max(size, p.cwiseAbs().maxCoeff());
  return 2.0 * std::numeric_limits<double>::epsilon() * std::max(size, 1e-3);
}

/// The data may have several local minima when they do not surround the axis or are few; then the
/// search starts from neighbouring axes too.
std::vector<CylinderFrame> starts(Points points, const CylinderFrame& best) {
  std::vector<CylinderFrame> out = {best};
  const auto frame = across(best.axis().direction);
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(frame.transpose() * p);
  const Eigen::Vector2d center = frame.transpose() * best.axis().point_mm;
  const bool full = largest_gap_rad(flat, center) <= 120.0 * core::kDegree;
  if (full && points.size() >= 12) return out;
  for (const double tilt_deg : {0.5, 2.0, 6.0}) {
    for (int k = 0; k < 8; ++k) {
      const double tilt = best.half_length_mm() * std::tan(tilt_deg * core::kDegree);
      const double angle = core::kTwoPi * k / 8.0;
      out.push_back(best.moved({0.0, 0.0, tilt * std::cos(angle), tilt * std::sin(angle)}));
    }
  }
  return out;
}

/// The solved zone with its local certificate; `points` are relative to their mean.
struct Solved {
  CylinderDescent state;
  Axis axis;  ///< Of the state, its point midway between the ends of the points.
  double half_length = 0.0;
  LocalProof<4> proof;
  Certificate certificate;
};

Solved solved(Points points, const CylinderDescent& state, double round_off) {
  Solved out{state, state.frame.axis(), half_extent(points, state.frame.axis().direction), {}, {}};
  double low = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : points) {
    low = std::min(low, (p - out.axis.point_mm).dot(out.axis.direction));
  }
  out.axis.point_mm += (low + out.half_length) * out.axis.direction;
  out.half_length = std::max(out.half_length, round_off);
  // A move along the axis changes no distance but by rounding; contacts must match what is stated.
  out.state.frame = CylinderFrame(out.axis, out.half_length);
  out.state.zone = extremes(points, out.state.frame);
  out.proof = prove_cylinder(points, out.state.frame, out.state.zone, round_off);
  out.certificate = certify_local<4>(out.proof, out.state.zone.width(), round_off,
                                     "next to the least-squares axis");
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
bool search_scope(Points points, const AxisScope& scope, const GlobalSearchOptions& options,
                  double round_off, Solved& solution, int& boxes) {
  const bool whole = scope.kind == AxisScope::Kind::kHalfSphere;
  const auto directions = whole ? cover_half_sphere() : cover_cone(scope.nominal, scope.cone_rad);
  for (int restart = 0; restart < kRestartLimit; ++restart) {
    if (solution.certificate.kind == Certificate::Kind::kNone) return false;
    if (auto reason = outside(solution, scope); !reason.empty()) {
      solution.certificate.reason = reason;
      return false;
    }
    const LocalProof<4>& proof = solution.proof;
    const double width = solution.state.zone.width();
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
    const double reach = std::max(half_extent(points, search.better->direction), round_off);
    CylinderDescent state{CylinderFrame(*search.better, reach), {}, {}, {}, 0};
    state.zone = extremes(points, state.frame);
    descend(points, state, round_off);
    state.programmes += solution.state.programmes;
    solution = solved(points, state, round_off);
  }
  return false;
}

MinZoneCylinder finish(const Solved& solution, const Eigen::Vector3d& mean) {
  MinZoneCylinder out;
  Axis axis = solution.axis;
  axis.point_mm += mean;
  out.axis = conventional(axis, mean);
  out.inner_radius_mm = solution.state.zone.low;
  out.outer_radius_mm = solution.state.zone.high;
  out.programmes = solution.state.programmes;
  out.certificate = solution.certificate;
  out.outer = solution.proof.outer;
  out.inner = solution.proof.inner;
  return out;
}

}  // namespace

core::Result<MinZoneCylinder> min_zone_cylinder(
    Points points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const MinZoneCylinderOptions& options) {
  const auto ls = ls_cylinder(points_mm, near_direction);
  if (!ls) return core::fail(ls.error());
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  points.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) points.emplace_back(p - mean);
  const double round_off = round_off_of(points_mm);

  Axis axis = ls->axis;
  axis.point_mm -= mean;
  const CylinderFrame first(axis, std::max(half_extent(points, axis.direction), round_off));
  std::optional<CylinderDescent> best;
  int programmes = 0;
  for (const CylinderFrame& frame : starts(points, first)) {
    CylinderDescent state{frame, extremes(points, frame), {}, {}, 0};
    descend(points, state, round_off);
    programmes += state.programmes;
    if (!best || state.zone.width() < best->zone.width()) best = state;
  }
  best->programmes = programmes;
  Solved solution = solved(points, *best, round_off);
  int boxes = 0;
  // All points on one cylinder to round-off: nothing is left to prove, no zone is narrower than 0.
  const bool exact = solution.state.zone.width() <= 16.0 * round_off;
  if (exact) {
    solution.certificate = {Certificate::Kind::kGlobal, "all directions",
                            solution.state.zone.width(), ""};
  }
  for (const AxisScope& scope : options.scopes) {
    if (exact) break;
    if (search_scope(points, scope, options.search, round_off, solution, boxes)) break;
  }
  MinZoneCylinder out = finish(solution, mean);
  out.boxes = boxes;
  return out;
}

}  // namespace rondure::fit
