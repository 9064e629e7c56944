#include "fit/references/min_zone_cone.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/geometry/internal/cone_frame.h"
#include "fit/zone/internal/coupled_zone.h"

namespace rondure::fit {
namespace {

/// A cone from which the distances of all points are measured.
struct ConeZoneModel {
  static constexpr int kUnknowns = ConeFrame::kUnknowns;
  SpacePoints points;
  ConeFrame frame;

  [[nodiscard]] double value(std::size_t i) const { return frame.distance(points[i]); }
  [[nodiscard]] std::pair<double, ConeFrame::Step> slope(std::size_t i) const {
    return frame.slope(points[i]);
  }
  [[nodiscard]] MeasuredRow row(std::size_t i) const {
    const auto exact = frame.contact_row(points[i], i);
    return {exact.distance, exact.gradient, exact.hessian};
  }
  [[nodiscard]] ConeZoneModel moved(const Eigen::VectorXd& step) const {
    return {points, frame.moved(ConeFrame::Step(step))};
  }
  [[nodiscard]] bool strayed(const ConeZoneModel& from) const { return frame.strayed(from.frame); }
  [[nodiscard]] double scale_mm() const { return frame.length_mm(); }
};

/// A gap this small counts as none; results are required to 1e-9 mm.
constexpr double kNoConeGap = 1e-9;

/// Width minus the lower bound that the contacts give for all cones whose unknowns are within a
/// width of these.
double first_order_gap(const CoupledZone<ConeZoneModel>& zone, double width) {
  if (zone.contacts.empty()) return width;
  double gap = 0.0;
  ConeFrame::Step imbalance = ConeFrame::Step::Zero();
  for (const CoupledContact& c : zone.contacts) {
    const double share = c.bound == 0 ? c.multiplier : -c.multiplier;
    const auto [value, slope] = zone.model.slope(c.row);
    gap += share * (zone.bounds(static_cast<Eigen::Index>(c.bound)) - value);
    imbalance += share * slope;
  }
  return std::clamp(gap + imbalance.lpNorm<1>() * width, 0.0, width);
}

}  // namespace

core::Result<MinZoneCone> min_zone_cone(SpacePoints points_mm,
                                        const std::optional<Eigen::Vector3d>& near_direction) {
  TRY(const auto start, ls_cone(points_mm, near_direction));
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  double length = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back(p - mean);
    length = std::max(length, points.back().norm());
  }
  Axis axis = start.cone.axis;
  axis.point_mm -= mean;
  const std::vector<CoupledBound> sides = {{0, points.size(), true}, {0, points.size(), false}};
  const ConeZoneModel from{points, ConeFrame(axis, 0.5 * start.cone.full_angle_rad, length)};
  const auto zone = CoupledDescent<ConeZoneModel>(from, sides).run();
  MinZoneCone out;
  out.ending = zone.ending;
  out.width_mm = zone.bounds(0) - zone.bounds(1);
  const ConeFrame& found = zone.model.frame;
  out.cone.axis = conventional(found.axis(), Eigen::Vector3d::Zero());
  const double turned = out.cone.axis.direction.dot(found.axis().direction);
  out.cone.full_angle_rad = (turned < 0.0 ? -2.0 : 2.0) * found.half_angle_rad();
  const double shift = (out.cone.axis.point_mm - found.axis().point_mm).dot(found.axis().direction);
  out.cone.offset_mm =
      0.5 * (zone.bounds(0) + zone.bounds(1)) + shift * std::sin(found.half_angle_rad());
  out.cone.axis.point_mm += mean;
  for (const CoupledContact& c : zone.contacts) {
    (c.bound == 0 ? out.outer : out.inner).push_back({c.row, c.multiplier});
  }
  std::ranges::sort(out.outer, {}, &Contact::index);
  std::ranges::sort(out.inner, {}, &Contact::index);
  out.certificate.scope = core::phrase("next to the least-squares cone");
  out.certificate.gap_mm = first_order_gap(zone, out.width_mm);
  if (zone.ending == ZoneEnding::kConverged) {
    out.certificate.kind = Certificate::Kind::kLocal;
    out.certificate.reason = core::phrase("other regions were not searched");
    return out;
  }
  // Where one generatrix holds the zone, cones that turn about it are as good to first order, and
  // no single one of them is a minimum to second order.
  if (out.certificate.gap_mm <= kNoConeGap) out.ending = ZoneEnding::kConverged;
  out.certificate.reason = core::phrase("the contacts hold the zone to first order only");
  return out;
}

}  // namespace rondure::fit
