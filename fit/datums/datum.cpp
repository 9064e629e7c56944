#include "fit/datums/datum.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/enclosing_ball.h"
#include "fit/zone/descent.h"

namespace rondure::fit {
namespace {

constexpr int kFewestOnCircle = 3;

/// Greatest minus least value of a measure over the points.
template <class Measure>
core::Result<double> range_mm(SpacePoints points, const Measure& measure) {
  if (auto checked = check_points(points); !checked) return core::fail(checked.error());
  return extremes_of(points, measure).width();
}

}  // namespace

core::Result<double> coaxiality_mm(SpacePoints median_mm, const Axis& datum) {
  if (auto checked = check_points(median_mm); !checked) return core::fail(checked.error());
  return 2.0 * extremes_of(median_mm, [&](const auto& c) { return distance_mm(datum, c); }).high;
}

core::Result<double> total_radial_run_out_mm(SpacePoints points_mm, const Axis& datum) {
  return range_mm(points_mm, [&](const Eigen::Vector3d& p) { return distance_mm(datum, p); });
}

core::Result<double> axial_run_out_mm(SpacePoints points_mm, const Axis& datum) {
  return orientation_of_plane_mm(points_mm, datum.direction);
}

core::Result<RunOut> radial_run_out(std::span<const std::vector<Eigen::Vector3d>> sections_mm,
                                    const Axis& datum) {
  if (sections_mm.empty()) {
    return core::fail(core::Code::kNoPoints, "there is no section; run-out needs at least one");
  }
  RunOut out;
  for (std::size_t i = 0; i < sections_mm.size(); ++i) {
    const auto section = total_radial_run_out_mm(sections_mm[i], datum);
    if (!section) {
      return core::fail(section.error().code,
                        fmt::format("section {}: {}", i, section.error().what));
    }
    out.sections_mm.push_back(*section);
    if (*section > out.sections_mm[out.greatest]) out.greatest = i;
  }
  return out;
}

core::Result<RunOut> circular_axial_run_out(SpacePoints points_mm, const Axis& datum,
                                            std::span<const double> radii_mm, double near_mm) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  if (radii_mm.empty()) {
    return core::fail(core::Code::kNoPoints,
                      "there is no radius; axial run-out needs at least one circle");
  }
  RunOut out;
  for (const double radius : radii_mm) {
    Extremes heights;
    int count = 0;
    for (const Eigen::Vector3d& p : points_mm) {
      if (!(std::abs(distance_mm(datum, p) - radius) <= near_mm)) continue;
      heights.take((p - datum.point_mm).dot(datum.direction));
      ++count;
    }
    if (count < kFewestOnCircle) {
      return core::fail(core::Code::kSampling,
                        fmt::format("{} points lie within {:g} mm of the radius {:g} mm about the "
                                    "datum axis, axial run-out needs at least {}: touch the face "
                                    "on circles about the datum axis",
                                    count, near_mm, radius, kFewestOnCircle));
    }
    out.sections_mm.push_back(heights.width());
    if (heights.width() > out.deviation_mm()) out.greatest = out.sections_mm.size() - 1;
  }
  return out;
}

core::Result<RunOut> conical_run_out(std::span<const std::vector<Eigen::Vector3d>> sections_mm,
                                     const Axis& datum, double half_angle_rad) {
  if (!(half_angle_rad >= 0.0 && half_angle_rad < 0.25 * core::kTwoPi)) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("the half angle of the cone is {:g} deg; 0 to below 90 deg are "
                                  "needed",
                                  core::degrees(half_angle_rad)));
  }
  auto out = radial_run_out(sections_mm, datum);
  if (!out) return out;
  for (double& section : out->sections_mm) section *= std::cos(half_angle_rad);
  return out;
}

core::Result<double> orientation_of_axis_mm(SpacePoints median_mm, const Eigen::Vector3d& datum) {
  if (auto checked = check_points(median_mm); !checked) return core::fail(checked.error());
  if (median_mm.size() < 2) {
    return core::fail(core::Code::kRank,
                      "one section gives no direction; the orientation of an axis needs at least "
                      "2 sections");
  }
  const auto frame = across(datum);
  const Eigen::Vector3d mean = mean_point(median_mm);
  std::vector<Eigen::Vector2d> flat;
  double size = 0.0;
  for (const Eigen::Vector3d& p : median_mm) {
    flat.emplace_back(frame.transpose() * (p - mean));
    size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  WorkingPoints<2> points;
  points.assign(flat, Eigen::Vector2d::Zero());
  return 2.0 * EnclosingBall<2>().enclose(points, false, distance_round_off(size)).zone.high;
}

core::Result<double> orientation_of_plane_mm(SpacePoints points_mm, const Eigen::Vector3d& normal) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  // From one of the points, so that a part far from the origin keeps its digits.
  return range_mm(points_mm,
                  [&](const Eigen::Vector3d& p) { return (p - points_mm.front()).dot(normal); });
}

}  // namespace rondure::fit
