#include "fit/datums/datum.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/enclosing_ball.h"
#include "fit/least_squares/line.h"
#include "fit/least_squares/plane.h"
#include "fit/zone/descent.h"

namespace rondure::fit {
namespace {

core::Result<void> check_median(SpacePoints median) {
  if (auto checked = check_points(median); !checked) return checked;
  if (median.size() >= 2) return {};
  return core::fail(core::Code::kRank,
                    "one section gives no direction; the orientation of an axis needs at least "
                    "2 sections");
}

core::Result<void> check_inclination(double angle_rad) {
  // An angle that comes from degrees may be above 90 deg by its rounding.
  if (angle_rad > 0.0 && angle_rad <= 0.25 * core::kTwoPi * (1.0 + 1e-12)) return {};
  return core::fail_with(core::Code::kBadOption,
                         "the angle to the datum is {:g} deg; above 0 and up to 90 deg are needed: "
                         "plan parallelism for 0 deg",
                         core::degrees(angle_rad));
}

/// The least circle round the points seen along a direction.
Ball<2> circle_along(SpacePoints median, const Eigen::Vector3d& mean,
                     const Eigen::Vector3d& direction) {
  const auto frame = across(direction);
  std::vector<Eigen::Vector2d> flat;
  double size = 0.0;
  for (const Eigen::Vector3d& p : median) {
    flat.emplace_back(frame.transpose() * (p - mean));
    size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  WorkingPoints<2> points;
  points.assign(flat, Eigen::Vector2d::Zero());
  return EnclosingBall<2>().enclose(points, false, distance_round_off(size));
}

/// Turns a direction, at a fixed angle to the datum, from next to the measured one to the least
/// value of a measure: bisects the sign of its slope, which is exact also where the measure has a
/// corner or hardly falls.
/// @param slope  Slope of the measure for a direction and the unit vector along which it turns.
template <class Slope>
core::Result<Eigen::Vector3d> least_turned(const Eigen::Vector3d& datum, double angle_rad,
                                           const Eigen::Vector3d& measured, const Slope& slope) {
  constexpr double kFarthest = 10.0 * core::kDegree;
  // The angle of planes and of lines is at most 90 deg: both sides are one direction.
  const double side = measured.dot(datum) < 0.0 ? -1.0 : 1.0;
  Eigen::Vector3d out = side * measured - side * measured.dot(datum) * datum;
  out =
      out.norm() > 0.0 ? Eigen::Vector3d(out.normalized()) : Eigen::Vector3d(across(datum).col(0));
  const Eigen::Vector3d beside = datum.cross(out);
  const auto direction = [&](double turn) -> Eigen::Vector3d {
    return side * (std::cos(angle_rad) * datum +
                   std::sin(angle_rad) * (std::cos(turn) * out + std::sin(turn) * beside));
  };
  const auto rises = [&](double turn) {
    return slope(direction(turn),
                 Eigen::Vector3d(side * (std::cos(turn) * beside - std::sin(turn) * out))) >= 0.0;
  };
  double high = 1e-6;
  double low = -high;
  while (high < kFarthest && !rises(high)) high *= 2.0;
  while (low > -kFarthest && rises(low)) low *= 2.0;
  if (high >= kFarthest || low <= -kFarthest) {
    return core::fail(core::Code::kNotConverged,
                      "no zone at the nominal angle to the datum is a minimum within 10 deg of the "
                      "measured direction: check the nominal angle");
  }
  for (double middle = 0.0; low < middle && middle < high; middle = 0.5 * (low + high)) {
    (rises(middle) ? high : low) = middle;
  }
  return direction(high);
}

}  // namespace

core::Result<double> coaxiality_mm(SpacePoints median_mm, const Axis& datum) {
  TRY_DO(check_points(median_mm));
  return 2.0 * extremes_of(median_mm, [&](const auto& c) { return distance_mm(datum, c); }).high;
}

core::Result<double> orientation_of_axis_mm(SpacePoints median_mm, const Eigen::Vector3d& datum) {
  TRY_DO(check_median(median_mm));
  return 2.0 * circle_along(median_mm, mean_point(median_mm), datum).zone.high;
}

core::Result<double> orientation_of_plane_mm(SpacePoints points_mm, const Eigen::Vector3d& normal) {
  TRY_DO(check_points(points_mm));
  // From one of the points, so that a part far from the origin keeps its digits.
  return extremes_of(points_mm,
                     [&](const Eigen::Vector3d& p) { return (p - points_mm.front()).dot(normal); })
      .width();
}

core::Result<InclinedZone> inclined_zone(SpacePoints points_mm, const Eigen::Vector3d& datum,
                                         double angle_rad,
                                         const std::optional<Eigen::Vector3d>& outward) {
  TRY_DO(check_inclination(angle_rad));
  TRY(const auto ls, ls_plane(points_mm, outward));
  InclinedZone out;
  const auto slope = [&](const Eigen::Vector3d& normal, const Eigen::Vector3d& along) {
    const auto [low, high] = std::ranges::minmax_element(
        points_mm, {}, [&](const auto& p) { return normal.dot(p - ls.plane.point_mm); });
    return along.dot(*high - *low);
  };
  TRY(const auto normal, least_turned(datum, angle_rad, ls.plane.normal, slope));
  out.outer = {ls.plane.point_mm, normal};
  const Extremes heights =
      extremes_of(points_mm, [&](const auto& p) { return height_mm(out.outer, p); });
  out.outer.point_mm += heights.high * normal;
  out.width_mm = heights.width();
  return out;
}

core::Result<double> angularity_of_axis_mm(SpacePoints median_mm, const Eigen::Vector3d& datum,
                                           double angle_rad) {
  TRY_DO(check_inclination(angle_rad));
  TRY_DO(check_median(median_mm));
  TRY(const auto ls, ls_line(median_mm));
  const auto slope = [&](const Eigen::Vector3d& axis, const Eigen::Vector3d& along) {
    const auto circle = circle_along(median_mm, ls.axis.point_mm, axis);
    const Eigen::Vector2d turn = across(axis).transpose() * along;
    // The centre follows the contacts, so that the radius grows as their weighted distances do.
    double sum = 0.0;
    for (const Contact& c : circle.outer) {
      const Eigen::Vector3d v = median_mm[c.index] - ls.axis.point_mm;
      const Eigen::Vector2d from = across(axis).transpose() * v - circle.center_mm;
      sum -= c.multiplier * v.dot(axis) * turn.dot(from);
    }
    return sum;
  };
  TRY(const auto axis, least_turned(datum, angle_rad, ls.axis.direction, slope));
  return orientation_of_axis_mm(median_mm, axis);
}

}  // namespace rondure::fit
